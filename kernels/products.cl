// Products of a segment X [rows x columns] with its square matrices of size `order`:
//
//   gram         G = X'X, or XX' for a wide segment (rows < columns); upper tiles only
//   reconstruct  W = sum_k f_k z_k z_k'     z_k: row k of Z
//   apply        A = XW,  or WX  for a wide segment
//   compose      C = PZ
//   basis        Z', or Z for a wide segment: what to apply to express X in the rows of Z
//
// A work-item computes tiles of TILE_ROWS rows x TILE_VECTORS vectors in registers; tiles that
// reach past the edge clamp their reads and skip their writes. Every sum runs over k in increasing
// order. Launch: (tiles across, tiles down the largest order, active segments) for all but apply,
// which takes one work-item per block of rows, and basis, one per row of a square matrix.

#ifndef TILE_ROWS
#error "TILE_ROWS is not defined: rows of a register tile"
#endif
#ifndef TILE_VECTORS
#error "TILE_VECTORS is not defined: vectors across a register tile"
#endif

#define TILE_COLUMNS (TILE_VECTORS * VW)

// Start of vector v of a tile, pulled back inside the matrix for vectors past its edge.
inline int clamped(int column, int v, int pitch) { return min(column + v * VW, pitch - VW); }

inline void store_tile(vreal tile[TILE_ROWS][TILE_VECTORS], global real* target, int pitch, int row,
                       int row_end, int column) {
  for (int r = 0; r < TILE_ROWS; ++r)
    for (int v = 0; v < TILE_VECTORS; ++v)
      if (row + r < row_end && column + v * VW < pitch)
        store(target + (row + r) * (size_t)pitch + column + v * VW, tile[r][v]);
}

// target tile = sum_k weight_k left[k][row ..] right[k][column ..], k = 0 .. depth - 1; both
// operands have `pitch`, and rows past `order` in the tile read the padding, which is zero.
inline void tile_of_outer_products(global const real* m, int pitch, int depth,
                                   global const real* weight, global real* target, int order,
                                   int row, int column) {
  vreal tile[TILE_ROWS][TILE_VECTORS];
#pragma unroll
  for (int r = 0; r < TILE_ROWS; ++r)
#pragma unroll
    for (int v = 0; v < TILE_VECTORS; ++v) tile[r][v] = 0;
  for (int k = 0; k < depth; ++k) {
    const real w = weight ? weight[k] : 1;
    if (w == 0) continue;
    global const real* mk = m + k * (size_t)pitch;
    vreal right[TILE_VECTORS];
#pragma unroll
    for (int v = 0; v < TILE_VECTORS; ++v) right[v] = load(mk + clamped(column, v, pitch));
#pragma unroll
    for (int r = 0; r < TILE_ROWS; ++r) {
      const vreal left = w * mk[min(row + r, pitch - 1)];
#pragma unroll
      for (int v = 0; v < TILE_VECTORS; ++v) tile[r][v] = fma(left, right[v], tile[r][v]);
    }
  }
  store_tile(tile, target, pitch, row, order, column);
}

// target tile = left[row ..][0 .. depth) * right[0 .. depth)[column ..].
inline void tile_of_product(global const real* left, int left_pitch, global const real* right,
                            int pitch, int depth, global real* target, int row, int row_end,
                            int column) {
  vreal tile[TILE_ROWS][TILE_VECTORS];
  global const real* l[TILE_ROWS];
#pragma unroll
  for (int r = 0; r < TILE_ROWS; ++r) {
    l[r] = left + min(row + r, row_end - 1) * (size_t)left_pitch;
#pragma unroll
    for (int v = 0; v < TILE_VECTORS; ++v) tile[r][v] = 0;
  }
  for (int k = 0; k < depth; ++k) {
    vreal b[TILE_VECTORS];
#pragma unroll
    for (int v = 0; v < TILE_VECTORS; ++v)
      b[v] = load(right + k * (size_t)pitch + clamped(column, v, pitch));
#pragma unroll
    for (int r = 0; r < TILE_ROWS; ++r) {
      const vreal a = l[r][k];
#pragma unroll
      for (int v = 0; v < TILE_VECTORS; ++v) tile[r][v] = fma(a, b[v], tile[r][v]);
    }
  }
  store_tile(tile, target, pitch, row, row_end, column);
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
                 global const real* x,              // [rows x pitch] stacked
                 global real* g) {  // order x order matrices; upper triangle written
  const segment_t s = segments[active[get_global_id(2)]];
  const int column = get_global_id(0) * TILE_COLUMNS;
  const int row = get_global_id(1) * TILE_ROWS;
  if (row >= s.order || column >= s.order || column + TILE_COLUMNS <= row) return;
  global const real* xs = x + s.first_row * s.pitch;
  if (is_wide(s))
    tile_of_row_products(xs, s, g + s.square, row, column);
  else
    tile_of_outer_products(xs, s.pitch, s.rows, 0, g + s.square, s.order, row, column);
}

kernel void reconstruct(global const segment_t* segments,  // [segments]
                        global const int* active,          // [active segments]
                        global const real* z,              // eigenvectors in rows, order x order
                        global const real* f,              // weights, `order` per segment
                        global real* w) {                  // order x order matrices
  const segment_t s = segments[active[get_global_id(2)]];
  const int column = get_global_id(0) * TILE_COLUMNS;
  const int row = get_global_id(1) * TILE_ROWS;
  if (row >= s.order || column >= s.order) return;
  tile_of_outer_products(z + s.square, s.order_pitch, s.order, f + s.vector, w + s.square, s.order,
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
  tile_of_product(p + s.square, s.order_pitch, z + s.square, s.order_pitch, s.order, c + s.square,
                  row, s.order, column);
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
    for (int row = block_begin(blocks[item]); row < end; row += TILE_ROWS)
      tile_of_product(left, left_pitch, right, s.pitch, s.order, a + s.first_row * s.pitch, row,
                      end, column);
}
