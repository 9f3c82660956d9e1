// Products of a segment X [rows x columns] with its square matrices of size `order`:
//
//   gram         G = X'X, or XX' for a wide segment (rows < columns); upper tiles only
//   reconstruct  W = sum_k f_k z_k z_k'     z_k: row k of Z
//   apply        A = XW,  or WX  for a wide segment
//   compose      C = PZ
//   basis        Z', or Z for a wide segment: what to apply to express X in the rows of Z
//
// A work-item computes register tiles (kernels/linalg/tiles.cl).
// Launch: (tiles across, tiles down the largest order, active segments) for all but apply, which
// takes one work-item per block of rows, and basis, one per row of a square matrix.

#include "linalg/tiles.cl"

// One tile from `column` on, or vector by vector where they do not fill it.
INLINE void outer_products(global const real* m, int pitch, int depth, global const real* weight,
                           global real* target, int order, int row, int column) {
  tile_t tile;
  if (column + TILE_COLUMNS <= pitch) {
    clear_tile(&tile, TILE_VECTORS);
    add_outer_products(&tile, m, pitch, depth, weight, row, column, TILE_VECTORS);
    store_tile(&tile, target, pitch, row, order, column, TILE_VECTORS);
    return;
  }
  for (; column < pitch; column += VW) {
    clear_tile(&tile, 1);
    add_outer_products(&tile, m, pitch, depth, weight, row, column, 1);
    store_tile(&tile, target, pitch, row, order, column, 1);
  }
}

INLINE void product(global const real* left, int left_pitch, global const real* right, int pitch,
                    int depth, global real* target, int row, int row_end, int column) {
  tile_t tile;
  if (column + TILE_COLUMNS <= pitch) {
    clear_tile(&tile, TILE_VECTORS);
    add_product(&tile, left, left_pitch, right, pitch, depth, row, row_end, column, TILE_VECTORS,
                0);
    store_tile(&tile, target, pitch, row, row_end, column, TILE_VECTORS);
    return;
  }
  for (; column < pitch; column += VW) {
    clear_tile(&tile, 1);
    add_product(&tile, left, left_pitch, right, pitch, depth, row, row_end, column, 1, 0);
    store_tile(&tile, target, pitch, row, row_end, column, 1);
  }
}

// G[i][j] = x_i . x_j for the tile's rows i and columns j >= i of a wide segment.
inline void tile_of_row_products(global const real* x, const segment_t s, global real* gram,
                                 int row, int column) {
  for (int i = row; i < min(row + TILE_ROWS, s.order); ++i)
    for (int j = column; j < min(column + TILE_COLUMNS, s.order); ++j) {
      vreal sum = 0;
      for (int k = 0; k < s.pitch; k += VW)
        sum = fma(load(x + i * (size_t)s.pitch + k), load(x + j * (size_t)s.pitch + k), sum);
      gram[i * (size_t)s.order_pitch + j] = lane_sum(sum);
    }
}

kernel void gram(global const segment_t* segments,  // [segments]
                 global const int* active,          // [active segments]
                 int wide_only,
                 global const real* x,  // [rows x pitch] stacked
                 global real* g) {      // order x order matrices; upper triangle written
  const segment_t s = segments[active[get_global_id(2)]];
  const int column = get_global_id(0) * TILE_COLUMNS;
  const int row = get_global_id(1) * TILE_ROWS;
  if (row >= s.order || column >= s.order || column + TILE_COLUMNS <= row) return;
  if (wide_only && !is_wide(s)) return;
  global const real* xs = x + s.first_row * s.pitch;
  if (is_wide(s))
    tile_of_row_products(xs, s, g + s.square, row, column);
  else
    outer_products(xs, s.pitch, s.rows, 0, g + s.square, s.order, row, column);
}

kernel void reconstruct(global const segment_t* segments,  // [segments]
                        global const int* active,          // [active segments]
                        global const real* z,              // eigenvectors in rows, order x order
                        global const real* f,              // weights, `order` per segment
                        global const int* counts,          // [segments]: terms; 0 leaves W as it is
                        global real* w) {                  // order x order matrices
  const int index = active[get_global_id(2)];
  const segment_t s = segments[index];
  const int column = get_global_id(0) * TILE_COLUMNS;
  const int row = get_global_id(1) * TILE_ROWS;
  if (row >= s.order || column >= s.order || counts[index] == 0) return;
  outer_products(z + s.square, s.order_pitch, counts[index], f + s.vector, w + s.square, s.order,
                 row, column);
}

kernel void compose(global const segment_t* segments,  // [segments]
                    global const int* active,          // [active segments]
                    global const real* p,              // order x order matrices
                    global const real* z,              // order x order matrices
                    global real* c) {                  // order x order matrices
  const segment_t s = segments[active[get_global_id(2)]];
  const int column = get_global_id(0) * TILE_COLUMNS;
  const int row = get_global_id(1) * TILE_ROWS;
  if (row >= s.order || column >= s.order) return;
  product(p + s.square, s.order_pitch, z + s.square, s.order_pitch, s.order, c + s.square, row,
          s.order, column);
}

kernel void basis(global const segment_t* segments,  // [segments]
                  global const int* active,          // [active segments]
                  global const real* z,              // order x order matrices
                  global real* b) {                  // order x order matrices
  const segment_t s = segments[active[get_global_id(1)]];
  const int row = get_global_id(0);
  if (row >= s.order) return;
  global real* target = b + s.square + row * (size_t)s.order_pitch;
  for (int j = 0; j < s.order_pitch; ++j) {
    const size_t source =
        is_wide(s) ? row * (size_t)s.order_pitch + j : j * (size_t)s.order_pitch + row;
    target[j] = j < s.order ? z[s.square + source] : 0;
  }
}

kernel void apply(global const segment_t* segments,  // [segments]
                  global const block_t* blocks,      // [block_count]
                  int block_count,
                  global const real* x,  // [rows x pitch] stacked
                  global const real* w,  // order x order matrices
                  global real* a) {      // [rows x pitch] stacked
  const int item = get_global_id(0);
  if (item >= block_count) return;
  const segment_t s = segments[blocks[item].segment];
  const int end = block_end(blocks[item], s);
  global const real* xs = x + s.first_row * s.pitch;
  global const real* left = is_wide(s) ? w + s.square : xs;
  global const real* right = is_wide(s) ? xs : w + s.square;
  const int left_pitch = is_wide(s) ? s.order_pitch : s.pitch;
  for (int column = 0; column < s.pitch; column += TILE_COLUMNS)
    for (int row = block_begin(blocks[item], s); row < end; row += TILE_ROWS)
      product(left, left_pitch, right, s.pitch, s.order, a + s.first_row * s.pitch, row, end,
              column);
}
