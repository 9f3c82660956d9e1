// The next direction of conjugate gradients and its product, in the notation of
// conjugate_gradients.cl, a work-item per block of rows:
//
//   direction   p = z + beta p,  q = W o p + Delta'P Delta p R,  p.q per block
//
// Delta'P Delta p is kept for CHUNK rows at a time; p.q is summed over vectors. An entry takes the
// steps of search_entry.cl, as in the form for GPUs (search_direction_group.cl). Launch: one
// work-item per block of rows.

#define ENTRY vreal
#define LOAD load
#include "linalg/tiles.cl"
#include "matrix_normal/conjugate_sums.cl"
#include "matrix_normal/search_entry.cl"

#ifndef CHUNK
#error "CHUNK is not defined: rows from the second differences to their product with R"
#endif

// p for the rows [row, end) of a vector of columns, `p` that of the first row of the segment, and
// Delta'P Delta p to `scratch`.
INLINE void differences(const search_t c, const segment_t s, int row, int end, int column,
                        global real* p, global real* scratch) {
  const int last = s.rows - 1;
  vreal far = direction_at(c, s, max(row - 2, 0), column);
  vreal near = direction_at(c, s, max(row - 1, 0), column);
  vreal p0 = direction_at(c, s, row, column);
  vreal p1 = direction_at(c, s, min(row + 1, last), column);
  vreal a2 = weighted_acceleration(c, row - 2, far, near, p0);
  vreal a1 = weighted_acceleration(c, row - 1, near, p0, p1);
  for (int i = row; i < end; ++i) {
    const vreal p2 = direction_at(c, s, min(i + 2, last), column);
    const vreal a0 = weighted_acceleration(c, i, p0, p1, p2);
    store(p + i * (size_t)s.pitch + column, p0);
    store(scratch + (i - row) * (size_t)s.pitch + column, second_difference(a2, a1, a0));
    a2 = a1;
    a1 = a0;
    p0 = p1;
    p1 = p2;
  }
}

// What the products of a chunk need, from its first row on.
typedef struct {
  global const real *scratch, *R;  // Delta'P Delta p
  global const real *weights, *p;
  global real* product;
  global const real *z_next, *p_next;  // what the next chunk begins with
  int rows, pitch, depth;
} chunk_t;

// Rows of what the next chunk begins with, another matrix per panel, for add_product to fetch.
INLINE global const real* fetched(const chunk_t c, int row, int column) {
  const size_t at = row * (size_t)c.pitch;
  const int panel = column / TILE_COLUMNS;
  if (panel == 0) return c.z_next + at;
  if (panel == 1) return c.p_next + at;
  return (panel == 2 ? c.weights : c.product) + CHUNK * (size_t)c.pitch + at;
}

// q = W o p + scratch R for a tile; returns the sum of p q. `whole` as a constant: no row of the
// tile lies past the end.
INLINE vreal product_tile(const chunk_t c, int row, int column, const int width, const int whole) {
  tile_t tile;
  clear_tile(&tile, width);
  add_product(&tile, c.scratch, c.pitch, c.R, c.pitch, c.depth, row, c.rows, column, width,
              fetched(c, row, column));
  vreal sum = 0;
  size_t at = row * (size_t)c.pitch + column;
#pragma unroll
  for (int r = 0; r < TILE_ROWS; ++r, at += c.pitch)
#pragma unroll
    for (int v = 0; v < width; ++v)
      if (whole || row + r < c.rows) {
        const size_t i = at + v * VW;
        store(c.product + i, completed(load(c.weights + i), load(c.p + i), tile.at[r][v], &sum));
      }
  return sum;
}

// The tiles of `width` vectors from `column` on, down the rows.
INLINE vreal product_panel(const chunk_t c, int column, const int width) {
  vreal sum = 0;
  int row = 0;
  for (; row + TILE_ROWS <= c.rows; row += TILE_ROWS) sum += product_tile(c, row, column, width, 1);
  if (row < c.rows) sum += product_tile(c, row, column, width, 0);
  return sum;
}

INLINE vreal product_rows(const chunk_t c) {
  vreal sum = 0;
  int column = 0;
  for (; column + TILE_COLUMNS <= c.pitch; column += TILE_COLUMNS)
    sum += product_panel(c, column, TILE_VECTORS);
  for (; column < c.pitch; column += VW) sum += product_panel(c, column, 1);
  return sum;
}

kernel void direction(global const segment_t* segments,  // [segments]
                      global const block_t* blocks,      // [block_count]
                      int block_count,
                      global const real* weights,      // W, [rows x pitch] stacked
                      global const real* R,            // order x order matrices
                      global const real* precisions,   // P, one per row, stacked
                      global const real* z,            // [rows x pitch] stacked
                      global const real* p_before,     // [rows x pitch] stacked
                      global const double* rz,         // [segments x vectors of columns]
                      global const double* rz_before,  // [segments x vectors of columns]
                      global const double* bz,         // [segments x vectors of columns]
                      double tolerance,                // negative: go on whatever r.z
                      int begins,                      // beta = 0
                      global real* scratch,            // [all blocks x CHUNK x pitch]
                      global real* p,                  // [rows x pitch] stacked
                      global real* product,            // q, [rows x pitch] stacked
                      global double* partial_pq,       // [all blocks]
                      global int* iterations) {        // [segments]
  const int item = get_global_id(0);
  if (item >= block_count) return;
  const block_t block = blocks[item];
  const segment_t s = segments[block.segment];
  const stage_t stage = stage_of(rz, rz_before, bz, block.segment, s, tolerance, begins);
  if (stage.enough) return;
  if (tolerance >= 0 && block.block == 0) ++iterations[block.segment];
  const search_t c = search_of(s, z, p_before, precisions, stage.beta);
  const size_t begin = s.first_row * s.pitch;
  const int end = block_end(block, s);
  global real* own = scratch + (s.first_block + block.block) * (size_t)(CHUNK * s.pitch);
  vreal sum = 0;
  for (int row = block_begin(block, s); row < end; row += CHUNK) {
    const int chunk_end = min(row + CHUNK, end);
    for (int column = 0; column < s.pitch; column += VW)
      differences(c, s, row, chunk_end, column, p + begin, own);
    const size_t at = begin + row * (size_t)s.pitch;
    const size_t next = at + CHUNK * (size_t)s.pitch;
    const chunk_t chunk = {own,      R + s.square,    weights + at,    p + at,  product + at,
                           z + next, p_before + next, chunk_end - row, s.pitch, s.order};
    sum += product_rows(chunk);
  }
  partial_pq[s.first_block + block.block] = lane_sum(sum);
}
