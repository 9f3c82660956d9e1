// Preconditioned conjugate gradients for W o S + Delta'Delta S R = W o D, Delta the second
// difference over the rows of a segment, R symmetric positive definite [columns x columns]; one
// system per segment, in the notation of host/moclean/solve/reference/matrix_normal.cpp:
//
//   factor      M = diag(W_j + least) + R_jj Delta'Delta = L diag(pivot) L' per column j
//   direction   p = z + beta p,  q = W o p + Delta'Delta p R,  p.q per block
//   start       r = W o D - q,   z = M^-1 r,  r.z and b.M^-1 b for b = W o D per vector of columns
//   update      S += alpha p,  r -= alpha q,  z = M^-1 r,  r.z per vector of columns
//
// A segment whose r.z has come down to `tolerance`^2 of b.M^-1 b is left as it is. Delta'Delta p is
// kept for CHUNK rows at a time.
// Every L has two bands; the second is R_jj / pivot two rows up, and is not stored.
//
// Launch: (vectors of columns, active segments), but direction: one work-item per block of rows.

#include "tiles.cl"

#define AHEAD 12  // rows from a row to what is fetched for the recurrences below or above it

#ifndef CHUNK
#error "CHUNK is not defined: rows from the second differences to their product with R"
#endif

// 1 where frame k begins a second difference, k may lie outside.
inline real coupled(int k, int rows) { return k >= 0 && k + 2 < rows; }

kernel void factor(global const segment_t* segments,  // [segments]
                   global const int* active,          // [active segments]
                   global const real* weights,        // W, [rows x pitch] stacked
                   global const real* stiffness,      // R_jj, one vector per segment
                   global const real* least,          // [segments]
                   global real* inverse_pivot,        // [rows x pitch] stacked
                   global real* first_band) {         // [rows x pitch] stacked
  const int b = active[get_global_id(1)], column = get_global_id(0) * VW;
  const segment_t s = segments[b];
  if (column >= s.pitch) return;
  const vreal q = load(stiffness + s.vector + column);
  size_t at = s.first_row * s.pitch + column;
  vreal inverse1 = 0, inverse2 = 0, l = 0;
  for (int i = 0; i < s.rows; ++i, at += s.pitch) {
    const real c0 = coupled(i, s.rows), c1 = coupled(i - 1, s.rows), c2 = coupled(i - 2, s.rows);
    const vreal u = q * (-2 * (c1 + c2)) - c2 * q * l;  // L(i, i - 1) pivot(i - 1)
    l = u * inverse1;
    vreal pivot = load(weights + at) + least[b] + (c0 + 4 * c1 + c2) * q;
    pivot -= u * l + c2 * q * q * inverse2;
    inverse2 = inverse1;
    inverse1 = 1 / pivot;
    store(inverse_pivot + at, inverse1);
    store(first_band + at, l);
  }
}

// z = L'^-1 diag(1 / pivot) y from the last row on; returns the sum of r z.
INLINE vreal solve_upwards(const segment_t s, vreal q, size_t begin,
                           global const real* inverse_pivot, global const real* first_band,
                           global const real* r, global real* z) {
  vreal z1 = 0, z2 = 0, l1 = 0, sum = 0;
  size_t at = begin + s.rows * (size_t)s.pitch;
  for (int i = s.rows - 1; i >= 0; --i) {
    at -= s.pitch;
    const size_t next = at - min(AHEAD, i) * (size_t)s.pitch;
    PREFETCH(inverse_pivot + next);
    PREFETCH(z + next);
    PREFETCH(first_band + next);
    PREFETCH(r + next);
    const vreal inverse = load(inverse_pivot + at);
    const vreal l2 = coupled(i, s.rows) * q * inverse;  // L(i + 2, i)
    const vreal value = fma(-l1, z1, fma(-l2, z2, load(z + at) * inverse));
    store(z + at, value);
    sum = fma(load(r + at), value, sum);
    z2 = z1;
    z1 = value;
    l1 = load(first_band + at);
  }
  return sum;
}

// One row of y = L^-1 r.
INLINE vreal next_downwards(vreal r, vreal l1, vreal l2, vreal y1, vreal y2) {
  return fma(-l1, y1, fma(-l2, y2, r));
}

INLINE vreal solve_downwards(const segment_t s, vreal q, size_t begin,
                             global const real* inverse_pivot, global const real* first_band,
                             global const real* r, global real* z) {
  vreal y1 = 0, y2 = 0, inverse1 = 0, inverse2 = 0;
  size_t at = begin;
  for (int i = 0; i < s.rows; ++i, at += s.pitch) {
    const vreal l2 = coupled(i - 2, s.rows) * q * inverse2;
    const vreal y = next_downwards(load(r + at), load(first_band + at), l2, y1, y2);
    store(z + at, y);
    y2 = y1;
    y1 = y;
    inverse2 = inverse1;
    inverse1 = load(inverse_pivot + at);
  }
  return solve_upwards(s, q, begin, inverse_pivot, first_band, r, z);
}

kernel void start(global const segment_t* segments,  // [segments]
                  global const int* active,          // [active segments]
                  global const real* data,           // D, [rows x pitch] stacked
                  global const real* weights,        // W, [rows x pitch] stacked
                  global const real* stiffness,      // R_jj, one vector per segment
                  global const real* inverse_pivot,  // [rows x pitch] stacked
                  global const real* first_band,     // [rows x pitch] stacked
                  global const real* product,        // q = W o S + Delta'Delta S R, stacked
                  global real* r,                    // [rows x pitch] stacked
                  global real* z,                    // [rows x pitch] stacked
                  global double* rz,                 // [segments x vectors of columns]
                  global double* bz) {               // [segments x vectors of columns]
  const int b = active[get_global_id(1)], column = get_global_id(0) * VW;
  const segment_t s = segments[b];
  if (column >= s.pitch) return;
  const vreal q = load(stiffness + s.vector + column);
  const size_t begin = s.first_row * s.pitch + column, place = b * (s.pitch / VW) + column / VW;
  const size_t end = begin + s.rows * (size_t)s.pitch;
  for (size_t at = begin; at < end; at += s.pitch)
    store(r + at, load(weights + at) * load(data + at));
  bz[place] = lane_sum(solve_downwards(s, q, begin, inverse_pivot, first_band, r, z));
  for (size_t at = begin; at < end; at += s.pitch) store(r + at, load(r + at) - load(product + at));
  rz[place] = lane_sum(solve_downwards(s, q, begin, inverse_pivot, first_band, r, z));
}

// Sum over the vectors of columns of a segment, in their order.
inline double sum_of_vectors(global const double* values, int b, const segment_t s) {
  const int vectors = s.pitch / VW;
  double sum = 0;
  for (int v = 0; v < vectors; ++v) sum += values[b * vectors + v];
  return sum;
}

inline int is_enough(double rz, global const double* bz, int b, const segment_t s,
                     double tolerance) {
  return !(rz > tolerance * tolerance * sum_of_vectors(bz, b, s));
}

kernel void update(global const segment_t* segments,       // [segments]
                   global const int* active,               // [active segments]
                   global const real* stiffness,           // R_jj, one vector per segment
                   global const real* inverse_pivot,       // [rows x pitch] stacked
                   global const real* first_band,          // [rows x pitch] stacked
                   global const real* p,                   // [rows x pitch] stacked
                   global const real* product,             // q, [rows x pitch] stacked
                   global const double* partial_pq,        // [all blocks]
                   global const double* rz,                // [segments x vectors of columns]
                   global const double* bz,                // [segments x vectors of columns]
                   double tolerance, global real* motion,  // S, [rows x pitch] stacked
                   global real* r,                         // [rows x pitch] stacked
                   global real* z,                         // [rows x pitch] stacked
                   global double* rz_next) {               // [segments x vectors of columns]
  const int b = active[get_global_id(1)], column = get_global_id(0) * VW;
  const segment_t s = segments[b];
  if (column >= s.pitch) return;
  const size_t begin = s.first_row * s.pitch + column, place = b * (s.pitch / VW) + column / VW;
  const double squares = sum_of_vectors(rz, b, s);
  rz_next[place] = rz[place];
  if (is_enough(squares, bz, b, s, tolerance)) return;
  double pq = 0;
  for (int i = 0; i < block_count_of(s); ++i) pq += partial_pq[s.first_block + i];
  const vreal alpha = squares / pq, q = load(stiffness + s.vector + column);

  vreal y1 = 0, y2 = 0, inverse1 = 0, inverse2 = 0;
  size_t at = begin;
  for (int i = 0; i < s.rows; ++i, at += s.pitch) {
    const size_t next = at + AHEAD * (size_t)s.pitch;
    PREFETCH(motion + next);
    PREFETCH(p + next);
    PREFETCH(product + next);
    PREFETCH(r + next);
    PREFETCH(z + next);
    PREFETCH(first_band + next);
    PREFETCH(inverse_pivot + next);
    store(motion + at, fma(alpha, load(p + at), load(motion + at)));
    const vreal rest = fma(-alpha, load(product + at), load(r + at));
    store(r + at, rest);
    const vreal l2 = coupled(i - 2, s.rows) * q * inverse2;
    const vreal y = next_downwards(rest, load(first_band + at), l2, y1, y2);
    store(z + at, y);
    y2 = y1;
    y1 = y;
    inverse2 = inverse1;
    inverse1 = load(inverse_pivot + at);
  }
  rz_next[place] = lane_sum(solve_upwards(s, q, begin, inverse_pivot, first_band, r, z));
}

// What a block works on.
typedef struct {
  global const real *z, *p_before;
  real beta;
  size_t begin;  // of the segment
} search_t;

INLINE vreal direction_at(const search_t c, const segment_t s, int row, int column) {
  const size_t at = c.begin + row * (size_t)s.pitch + column;
  return c.beta == 0 ? load(c.z + at) : fma((vreal)c.beta, load(c.p_before + at), load(c.z + at));
}

// Second difference that begins with frame k, given its first two rows; 0 beyond the ends.
INLINE vreal acceleration(const segment_t s, int k, vreal p0, vreal p1, vreal p2) {
  return coupled(k, s.rows) * (p0 - 2 * p1 + p2);
}

// p for the rows [row, end) of a vector of columns, and Delta'Delta p to `scratch`.
INLINE void differences(const search_t c, const segment_t s, int row, int end, int column,
                        global real* p, global real* scratch) {
  const int last = s.rows - 1;
  vreal far = direction_at(c, s, max(row - 2, 0), column);
  vreal near = direction_at(c, s, max(row - 1, 0), column);
  vreal p0 = direction_at(c, s, row, column);
  vreal p1 = direction_at(c, s, min(row + 1, last), column);
  vreal a2 = acceleration(s, row - 2, far, near, p0), a1 = acceleration(s, row - 1, near, p0, p1);
  for (int i = row; i < end; ++i) {
    const vreal p2 = direction_at(c, s, min(i + 2, last), column);
    const vreal a0 = acceleration(s, i, p0, p1, p2);
    store(p + c.begin + i * (size_t)s.pitch + column, p0);
    store(scratch + (i - row) * (size_t)s.pitch + column, a2 - 2 * a1 + a0);
    a2 = a1;
    a1 = a0;
    p0 = p1;
    p1 = p2;
  }
}

// What the products of a chunk need, from its first row on.
typedef struct {
  global const real *scratch, *R;  // Delta'Delta p
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
        const vreal p = load(c.p + at + v * VW);
        const vreal q = fma(load(c.weights + at + v * VW), p, tile.at[r][v]);
        store(c.product + at + v * VW, q);
        sum = fma(p, q, sum);
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
  search_t c = {z, p_before, 0, s.first_row * s.pitch};
  if (tolerance >= 0) {
    const double squares = sum_of_vectors(rz, block.segment, s);
    if (is_enough(squares, bz, block.segment, s, tolerance)) return;
    if (!begins) c.beta = squares / sum_of_vectors(rz_before, block.segment, s);
    if (block.block == 0) ++iterations[block.segment];
  }
  const int end = block_end(block, s);
  global real* own = scratch + (s.first_block + block.block) * (size_t)(CHUNK * s.pitch);
  vreal sum = 0;
  for (int row = block_begin(block, s); row < end; row += CHUNK) {
    const int chunk_end = min(row + CHUNK, end);
    for (int column = 0; column < s.pitch; column += VW)
      differences(c, s, row, chunk_end, column, p, own);
    const size_t at = c.begin + row * (size_t)s.pitch;
    const size_t next = at + CHUNK * (size_t)s.pitch;
    const chunk_t chunk = {own,      R + s.square,    weights + at,    p + at,  product + at,
                           z + next, p_before + next, chunk_end - row, s.pitch, s.order};
    sum += product_rows(chunk);
  }
  partial_pq[s.first_block + block.block] = lane_sum(sum);
}
