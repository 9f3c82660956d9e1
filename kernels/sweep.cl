// One sweep over the rows of a segment: what an iteration of robust PCA does between two
// eigenproblems, in the notation of host/moclean/solve/reference/robust_pca.cpp.
//
//   A = XW                                    W = V diag(f) V', or (XV) diag(f) V' at low rank
//   order ae: T = D - A + Y/mu                Y+ = clamp(mu T, -lambda, lambda)
//             X+ = A - Y/mu + Y+ (1/mu + 1/mu+)
//   order ea: Y+ = mu (X - A)                 T+ = D - A + Y+/mu+
//             E+ = soft(T+, lambda/mu+)       X+ = A + clamp(T+, -lambda/mu+, lambda/mu+)
//   G += X+'X+ (upper triangle)               |D - A - E|_F^2 += |(Y+ - Y)/mu|^2
//
// The forms follow from E = soft(T, lambda/mu) = T - Y+/mu and X = D - E + Y/mu: neither A nor E is
// stored. `shrink` is the same for an A that is there already; `finish` gives A and E at the end.
// Launch: one work-item per block of rows. A block is done SWEEP_ROWS rows at a time, so that they
// are in the nearest cache when their Gram matrix is formed.

#include "state.cl"
#include "tiles.cl"

#ifndef SWEEP_ROWS
#error "SWEEP_ROWS is not defined: rows from the product to the Gram matrix, times TILE_ROWS"
#endif

// Multiply-adds per entry of a tile between two prefetches.
#define PREFETCH_EVERY 20

// What a sweep reports of its block.
typedef struct {
  vreal squares;  // of D - A - E
  vreal largest;  // |mu T|: E is zero where it does not exceed lambda
} sums_t;

// The scalars of one iteration.
typedef struct {
  real mu, inverse_mu, inverse_next, lambda;
} scalars_t;

INLINE scalars_t scalars_of(global const state_t* state) {
  const scalars_t k = {state->mu, 1 / state->mu, 1 / state->mu_next, state->lambda};
  return k;
}

// min(max(t, -limit), limit). Comparisons compile to one instruction each; fmin and fmax, which
// look for NaN, to four.
INLINE vreal limited(vreal t, real limit) {
  const vreal raised = t < -limit ? (vreal)-limit : t;
  return raised > limit ? (vreal)limit : raised;
}

// Y -> Y+ and X -> X+ where A is known, order ae.
INLINE void update_ae(const scalars_t k, vreal a, vreal d, global real* y, global real* x_next,
                      sums_t* sums) {
  const vreal dual = load(y);
  const vreal t = fma((vreal)k.mu, d - a, dual);
  const vreal dual_next = limited(t, k.lambda);
  const vreal rest = (dual_next - dual) * k.inverse_mu;
  sums->squares = fma(rest, rest, sums->squares);
  sums->largest = fabs(t) > sums->largest ? fabs(t) : sums->largest;
  store(y, dual_next);
  store(x_next,
        fma(dual_next, (vreal)(k.inverse_mu + k.inverse_next), fma(dual, (vreal)-k.inverse_mu, a)));
}

// The same for order ea, and E+, which belongs to the next A.
INLINE void update_ea(const scalars_t k, vreal a, vreal d, vreal x, global real* y,
                      global real* x_next, global real* e_next, sums_t* sums) {
  const vreal dual = load(y);
  const vreal dual_next = k.mu * (x - a);
  const vreal rest = (dual_next - dual) * k.inverse_mu;
  const vreal t_next = fma(dual_next, (vreal)k.inverse_next, d - a);
  const vreal kept = limited(t_next, k.lambda * k.inverse_next);
  sums->squares = fma(rest, rest, sums->squares);
  store(y, dual_next);
  store(x_next, a + kept);
  store(e_next, t_next - kept);
}

// The matrices of one segment.
typedef struct {
  global const real *d, *x, *w, *v, *z, *f;
  global real *y, *x_next, *e_next, *projected;
} matrices_t;

// What a tile will read and write, and the rows of X that come next, is asked for in four portions,
// so that it arrives while products are computed and does not keep their loads waiting. Rows past
// the end may be asked for: it is a hint.
INLINE void prefetch_portion(const matrices_t m, int pitch, int row, int column, const int width,
                             int portion) {
  if (portion > 3) return;
  global const real* base = portion == 0   ? m.d
                            : portion == 1 ? m.y
                            : portion == 2 ? m.x_next
                                           : m.x + SWEEP_ROWS * (size_t)pitch;
  base += row * (size_t)pitch + column;
#pragma unroll
  for (int r = 0; r < TILE_ROWS; ++r, base += pitch)
#pragma unroll
    for (int v = 0; v < width; ++v) PREFETCH(base + v * VW);
}

// `whole` as a constant: no row of the tile lies past the end.
INLINE void update_tile(const scalars_t k, const tile_t* a, const matrices_t m, const int order_ea,
                        const int whole, int pitch, int row, int row_end, int column,
                        const int width, sums_t* sums) {
  size_t start = row * (size_t)pitch + column;
#pragma unroll
  for (int r = 0; r < TILE_ROWS; ++r, start += pitch)
#pragma unroll
    for (int v = 0; v < width; ++v)
      if (whole || row + r < row_end) {
        const size_t at = start + v * VW;
        if (order_ea)
          update_ea(k, a->at[r][v], load(m.d + at), load(m.x + at), m.y + at, m.x_next + at,
                    m.e_next + at, sums);
        else
          update_ae(k, a->at[r][v], load(m.d + at), m.y + at, m.x_next + at, sums);
      }
}

// The factors of A = left right; rows of `left` count as those of A.
typedef struct {
  global const real *left, *right;
  int left_pitch, depth;
} factors_t;

// One tile of A and all that follows from it.
INLINE void sweep_tile(const factors_t p, const scalars_t k, const matrices_t m, int order_ea,
                       int pitch, int row, int row_end, int column, const int width, sums_t* sums) {
  tile_t a;
  clear_tile(&a, width);
  int portion = 0;
  for (int k0 = 0; k0 < p.depth; k0 += PREFETCH_EVERY) {
    prefetch_portion(m, pitch, row, column, width, portion++);
    if (p.depth <= PREFETCH_EVERY)
      while (portion < 4) prefetch_portion(m, pitch, row, column, width, portion++);
    add_product(&a, p.left + k0, p.left_pitch, p.right + k0 * (size_t)pitch, pitch,
                min(PREFETCH_EVERY, p.depth - k0), row, row_end, column, width);
  }
  if (order_ea)
    update_tile(k, &a, m, 1, 0, pitch, row, row_end, column, width, sums);
  else if (row + TILE_ROWS <= row_end)
    update_tile(k, &a, m, 0, 1, pitch, row, row_end, column, width, sums);
  else
    update_tile(k, &a, m, 0, 0, pitch, row, row_end, column, width, sums);
}

INLINE void sweep_rows(const factors_t p, const scalars_t k, const matrices_t m, int order_ea,
                       int pitch, int begin, int end, sums_t* sums) {
  int column = 0;
  for (; column + TILE_COLUMNS <= pitch; column += TILE_COLUMNS)
    for (int row = begin; row < end; row += TILE_ROWS)
      sweep_tile(p, k, m, order_ea, pitch, row, end, column, TILE_VECTORS, sums);
  for (; column < pitch; column += VW)
    for (int row = begin; row < end; row += TILE_ROWS)
      sweep_tile(p, k, m, order_ea, pitch, row, end, column, 1, sums);
}

INLINE void project_tile(const matrices_t m, const segment_t s, int begin, int row, int row_end,
                         int column, const int width) {
  tile_t tile;
  clear_tile(&tile, width);
  add_product(&tile, m.x, s.pitch, m.v, s.order_pitch, s.order, row, row_end, column, width);
#pragma unroll
  for (int r = 0; r < TILE_ROWS; ++r)
#pragma unroll
    for (int v = 0; v < width; ++v) tile.at[r][v] *= load(m.f + column + v * VW);
  store_tile(&tile, m.projected, s.order_pitch, row - begin, row_end - begin, column, width);
}

// B = (XV) diag(f), rows begin .. end, into the rows 0 .. of `projected`.
INLINE void project(const matrices_t m, const segment_t s, int rank, int begin, int end) {
  int column = 0;
  for (; column + TILE_COLUMNS < rank + VW; column += TILE_COLUMNS)
    for (int row = begin; row < end; row += TILE_ROWS)
      project_tile(m, s, begin, row, end, column, TILE_VECTORS);
  for (; column < rank; column += VW)
    for (int row = begin; row < end; row += TILE_ROWS)
      project_tile(m, s, begin, row, end, column, 1);
}

INLINE factors_t factors_of(const matrices_t m, const segment_t s, global const state_t* state,
                            int begin, int end) {
  if (is_wide(s)) return (factors_t){m.w, m.x, s.order_pitch, s.order};
  if (!state->low_rank) return (factors_t){m.x, m.w, s.pitch, s.order};
  project(m, s, state->rank, begin, end);
  return (factors_t){m.projected - begin * (size_t)s.order_pitch, m.z, s.order_pitch, state->rank};
}

kernel void start(global const segment_t* segments,  // [segments]
                  global const block_t* blocks,      // [block_count]
                  int block_count,
                  global const state_t* states,  // [segments]
                  global const real* data,       // D [rows x pitch] stacked
                  global real* y,                // Y
                  global real* x,                // X
                  global real* e) {              // E, order ea only
  const int item = get_global_id(0);
  if (item >= block_count) return;
  const segment_t s = segments[blocks[item].segment];
  global const state_t* state = states + blocks[item].segment;
  const size_t first = (s.first_row + block_begin(blocks[item], s)) * s.pitch;
  const size_t last = (s.first_row + block_end(blocks[item], s)) * s.pitch;
  const real inverse_mu = 1 / state->mu, dual_scale = state->dual_scale;
  const real limit = state->lambda * inverse_mu;
  for (size_t i = first; i < last; i += VW) {
    const vreal d = load(data + i);
    const vreal dual = d * dual_scale;
    const vreal t = fma(dual, (vreal)inverse_mu, d);
    store(y + i, dual);
    const vreal kept = state->order_ea ? limited(t, limit) : t;
    store(x + i, kept);  // E = soft(T) and X = T - E
    if (state->order_ea) store(e + i, t - kept);
  }
}

kernel void sweep(global const segment_t* segments,  // [segments]
                  global const block_t* blocks,      // [block_count]
                  int block_count,
                  global const state_t* states,  // [segments]
                  global const real* data,       // D [rows x pitch] stacked
                  global const real* x,          // X
                  global real* y,                // Y -> Y+
                  global real* x_next,           // X+
                  global real* e_next,           // E+, order ea only
                  global const real* w,          // order x order matrices
                  global const real* v,          // order x order matrices: vectors in columns
                  global const real* z,          // order x order matrices: vectors in rows
                  global const real* f,          // `order` per segment
                  global real* projected,        // [block_count x SWEEP_ROWS x pitch], scratch
                  int with_gram,                 // 0 also where it takes another number type than X
                  global real* g,                // order x order matrices: of the first blocks
                  global real* partial_grams,    // order x order matrices: of the other blocks
                  global double* partial_squares,  // [all blocks]: |D - A - E|_F^2
                  global int* partial_sparse) {    // [all blocks]: whether E is not zero
  const int item = get_global_id(0);
  if (item >= block_count) return;
  const block_t block = blocks[item];
  const segment_t s = segments[block.segment];
  global const state_t* state = states + block.segment;
  if (state->finished) return;
  const scalars_t k = scalars_of(state);
  const size_t first = s.first_row * s.pitch;
  const matrices_t m = {data + first,   x + first,
                        w + s.square,   v + s.square,
                        z + s.square,   f + s.vector,
                        y + first,      x_next + first,
                        e_next + first, projected + item * (size_t)SWEEP_ROWS * s.pitch};
  global real* gram = block.block == 0 ? g + s.square
                                       : partial_grams + s.partial +
                                             (block.block - 1) * (size_t)s.order * s.order_pitch;
  const int begin = block_begin(block, s), end = block_end(block, s);
  sums_t sums = {0, 0};
  for (int row = begin; row < end; row += SWEEP_ROWS) {
    const int row_end = min(row + SWEEP_ROWS, end);
    sweep_rows(factors_of(m, s, state, row, row_end), k, m, state->order_ea, s.pitch, row, row_end,
               &sums);
    if (with_gram && !is_wide(s))
      add_gram(m.x_next + row * (size_t)s.pitch, gram, row == begin, s, row_end - row);
  }
  partial_squares[s.first_block + block.block] = lane_sum(sums.squares);
  partial_sparse[s.first_block + block.block] = lane_max(sums.largest) > k.lambda;
}

kernel void shrink(global const segment_t* segments,  // [segments]
                   global const block_t* blocks,      // [block_count]
                   int block_count,
                   global const state_t* states,    // [segments]
                   global const real* data,         // D [rows x pitch] stacked
                   global const real* x,            // X
                   global real* y,                  // Y -> Y+
                   global real* a,                  // A -> X+
                   global real* e_next,             // E+, order ea only
                   global double* partial_squares,  // [all blocks]
                   global int* partial_sparse) {    // [all blocks]
  const int item = get_global_id(0);
  if (item >= block_count) return;
  const segment_t s = segments[blocks[item].segment];
  global const state_t* state = states + blocks[item].segment;
  if (state->finished) return;
  const scalars_t k = scalars_of(state);
  const size_t first = (s.first_row + block_begin(blocks[item], s)) * s.pitch;
  const size_t last = (s.first_row + block_end(blocks[item], s)) * s.pitch;
  sums_t sums = {0, 0};
  for (size_t i = first; i < last; i += VW)
    if (state->order_ea)
      update_ea(k, load(a + i), load(data + i), load(x + i), y + i, a + i, e_next + i, &sums);
    else
      update_ae(k, load(a + i), load(data + i), y + i, a + i, &sums);
  partial_squares[s.first_block + blocks[item].block] = lane_sum(sums.squares);
  partial_sparse[s.first_block + blocks[item].block] = lane_max(sums.largest) > k.lambda;
}

// A = XW and E of segments that have finished, from the X that their last iteration read and the X+
// and Y+ that it wrote; mu is mu+ by now:
//   order ae: E = D + Y+/mu+ - X+, and zero where |Y+| < lambda; order ea: as it was kept.
kernel void finish(global const segment_t* segments,  // [segments]
                   global const block_t* blocks,      // [block_count]
                   int block_count,
                   global const state_t* states,  // [segments]
                   global const real* x_even,     // X of iterations 0, 2, ..
                   global const real* x_odd,      // X of iterations 1, 3, ..
                   global const real* e_even,     // E likewise, order ea only
                   global const real* e_odd,
                   global const real* w,  // order x order matrices
                   global real* data,     // D -> A
                   global real* y) {      // Y+ -> E
  const int item = get_global_id(0);
  if (item >= block_count) return;
  const segment_t s = segments[blocks[item].segment];
  global const state_t* state = states + blocks[item].segment;
  const size_t first = s.first_row * s.pitch;
  const int begin = block_begin(blocks[item], s), end = block_end(blocks[item], s);
  const real lambda = state->lambda;
  const int last_odd = (state->iterations + 1) % 2;
  global const real* x = (last_odd ? x_odd : x_even) + first;
  global const real* x_next = (last_odd ? x_even : x_odd) + first;
  global const real* e = (last_odd ? e_odd : e_even) + first;
  for (size_t i = begin * (size_t)s.pitch; i < end * (size_t)s.pitch; i += VW) {
    if (state->order_ea) {
      store(y + first + i, load(e + i));
    } else {
      const vreal dual = load(y + first + i);
      const vreal sparse =
          fma(dual, (vreal)(1 / state->mu), load(data + first + i)) - load(x_next + i);
      store(y + first + i, fabs(dual) < lambda ? (vreal)0 : sparse);
    }
  }
  global const real* left = is_wide(s) ? w + s.square : x;
  global const real* right = is_wide(s) ? x : w + s.square;
  const int left_pitch = is_wide(s) ? s.order_pitch : s.pitch;
  for (int row = begin; row < end; row += TILE_ROWS)
    for (int column = 0; column < s.pitch; column += VW) {
      tile_t a;
      clear_tile(&a, 1);
      add_product(&a, left, left_pitch, right, s.pitch, s.order, row, end, column, 1);
      store_tile(&a, data + first, s.pitch, row, end, column, 1);
    }
}
