// Register tiles of matrix products.
//
// A tile has TILE_ROWS rows x TILE_VECTORS vectors, enough independent sums to hide the latency of
// a multiply-add and few enough to stay in registers; at the right edge of a matrix it is one
// vector wide. `width` is always one of the two, as a constant, so that the loops unroll. Rows past
// the lower edge are read from the last row and not written. Every sum runs over k in increasing
// order, so a tile's shape does not change its values.
//
// No loop here copies neighbouring vectors to or from an array: compilers make a memcpy of it
// before they come to unroll it, and the array lives in memory from then on. So loads stand where
// they are used, in every row again, and are taken together by the compiler; copies go down the
// columns.

#ifndef TILE_ROWS
#error "TILE_ROWS is not defined: rows of a register tile"
#endif
#ifndef TILE_VECTORS
#error "TILE_VECTORS is not defined: vectors across a register tile"
#endif

#define TILE_COLUMNS (TILE_VECTORS * VW)

typedef struct {
  vreal at[TILE_ROWS][TILE_VECTORS];
} tile_t;

INLINE void clear_tile(tile_t* tile, const int width) {
#pragma unroll
  for (int r = 0; r < TILE_ROWS; ++r)
#pragma unroll
    for (int v = 0; v < width; ++v) tile->at[r][v] = 0;
}

INLINE void load_tile(tile_t* tile, global const real* source, int pitch, int row, int row_end,
                      int column, const int width) {
#pragma unroll
  for (int v = 0; v < width; ++v)
#pragma unroll
    for (int r = 0; r < TILE_ROWS; ++r)
      tile->at[r][v] = load(source + min(row + r, row_end - 1) * (size_t)pitch + column + v * VW);
}

INLINE void store_rows(const tile_t* tile, global real* target, int pitch, int rows,
                       const int width) {
#pragma unroll
  for (int v = 0; v < width; ++v)
#pragma unroll
    for (int r = 0; r < TILE_ROWS; ++r)
      if (r < rows) store(target + r * (size_t)pitch + v * VW, tile->at[r][v]);
}

INLINE void store_tile(const tile_t* tile, global real* target, int pitch, int row, int row_end,
                       int column, const int width) {
  target += row * (size_t)pitch + column;
  if (row + TILE_ROWS <= row_end)
    store_rows(tile, target, pitch, TILE_ROWS, width);
  else
    store_rows(tile, target, pitch, row_end - row, width);
}

// tile += sum_k weight_k m[k][row ..] m[k][column ..], k = 0 .. depth - 1, all weights 1 if there
// are none. `whole` as a constant: no row of the tile lies past the edge of `m`; those that do read
// its padding, which is zero.
INLINE void add_weighted_rows(tile_t* tile, global const real* m, int pitch, int depth,
                              global const real* weight, int row, int column, const int width,
                              const int whole) {
  for (int k = 0; k < depth; ++k) {
    const real w = weight ? weight[k] : 1;
    global const real* mk = m + k * (size_t)pitch;
#pragma unroll
    for (int r = 0; r < TILE_ROWS; ++r) {
      const vreal left = w * mk[whole ? row + r : min(row + r, pitch - 1)];
#pragma unroll
      for (int v = 0; v < width; ++v)
        tile->at[r][v] = fma(left, load(mk + column + v * VW), tile->at[r][v]);
    }
  }
}

INLINE void add_outer_products(tile_t* tile, global const real* m, int pitch, int depth,
                               global const real* weight, int row, int column, const int width) {
  if (row + TILE_ROWS <= pitch)
    add_weighted_rows(tile, m, pitch, depth, weight, row, column, width, 1);
  else
    add_weighted_rows(tile, m, pitch, depth, weight, row, column, width, 0);
}

// tile += left[row ..][0 .. depth) * right[0 .. depth)[column ..]. Meanwhile `depth` vectors from
// `ahead` on, if not null, are brought into the caches.
INLINE void add_product(tile_t* tile, global const real* left, int left_pitch,
                        global const real* right, int pitch, int depth, int row, int row_end,
                        int column, const int width, global const real* ahead) {
  global const real* l[TILE_ROWS];
#pragma unroll
  for (int r = 0; r < TILE_ROWS; ++r) l[r] = left + min(row + r, row_end - 1) * (size_t)left_pitch;
  for (int k = 0; k < depth; ++k) {
    global const real* b = right + k * (size_t)pitch + column;
    if (ahead) PREFETCH(ahead + k * VW);
#pragma unroll
    for (int r = 0; r < TILE_ROWS; ++r) {
      const vreal a = l[r][k];
#pragma unroll
      for (int v = 0; v < width; ++v) tile->at[r][v] = fma(a, load(b + v * VW), tile->at[r][v]);
    }
  }
}

INLINE void gram_tile(global const real* x, global real* g, int begins, const segment_t s, int rows,
                      int row, int column, const int width) {
  tile_t tile;
  if (begins)
    clear_tile(&tile, width);
  else
    load_tile(&tile, g, s.pitch, row, s.order, column, width);
  add_outer_products(&tile, x, s.pitch, rows, 0, row, column, width);
  store_tile(&tile, g, s.pitch, row, s.order, column, width);
}

// Where the Gram matrix of a block is summed up: in G of the segment for its first, else in one of
// its partial matrices.
INLINE global real* gram_of(const block_t block, const segment_t s, global real* g,
                            global real* partial_grams) {
  if (block.block == 0) return g + s.square;
  return partial_grams + s.partial + (block.block - 1) * (size_t)s.order * s.order_pitch;
}

// G += X'X for `rows` rows of X, the tiles that hold a part of the upper triangle; `begins` if they
// are the first.
INLINE void add_gram(global const real* x, global real* g, int begins, const segment_t s,
                     int rows) {
  for (int row = 0; row < s.order; row += TILE_ROWS) {
    int column = row / VW * VW;
    for (; column + TILE_COLUMNS <= s.pitch; column += TILE_COLUMNS)
      gram_tile(x, g, begins, s, rows, row, column, TILE_VECTORS);
    for (; column < s.pitch; column += VW) gram_tile(x, g, begins, s, rows, row, column, 1);
  }
}
