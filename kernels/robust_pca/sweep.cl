// One sweep over the rows of a segment: what an iteration of robust PCA does between two
// eigenproblems, in the notation of kernels/robust_pca/entry.cl.
//
//   order ae: X = D - E + Y/mu                A = XW, or (XV) diag(f) V' at low rank
//             T = mu (D - A) + Y              Y+ = clamp(T, -lambda, lambda), E = (T - Y+) / mu
//             X+ = D - E + Y+/mu+
//   order ea: the same X and A                Y+ = mu (X - A), X+ = D - E+ + Y+/mu+
//   G += X+'X+ (upper triangle)               |D - A - E|_F^2 += |(Y+ - Y)/mu|^2
//
// Only T, or Y and A, are stored. A block of rows is done SWEEP_ROWS rows at a time, a chunk, whose
// X, XV and X+ stay in the nearest caches. X+ is formed twice, for its Gram matrix and again at the
// start of the next iteration: that takes less time than to write and read it.
//
//   sweep_full, sweep_low_rank, sweep_wide   the sweep, of the segments whose A is XW, (XV) diag(f)
//                                            V', or WX; each leaves alone those of the other two
//   start    Y and A before the first iteration
//   form     X where it is needed as a whole
//   shrink   the element-wise steps for an A that is there already
//   finish   E at the end
//
// Missing entries are known to `start` and `shrink` only. Launch: one work-item per block of rows.

#include "linalg/tiles.cl"
#include "robust_pca/state.cl"

#ifndef SWEEP_ROWS
#error "SWEEP_ROWS is not defined: rows from the product to the Gram matrix"
#endif

#define ENTRY vreal
#define SCALAR real
#include "robust_pca/entry.cl"

// What a sweep reports of its block.
typedef struct {
  vreal squares;  // of Y+ - Y = mu (D - A - E)
  vreal sparse;   // of mu E
} sums_t;

INLINE report_t report_of(const sums_t sums, const scalars_t k) {
  const double gap = sqrt((double)lane_sum(sums.squares)) * k.inverse_mu;
  const report_t report = {gap * gap, lane_sum(sums.sparse) > 0};
  return report;
}

// The stacked matrices that an iteration keeps.
typedef struct {
  global const real* d;
  global real *t, *a, *e;  // e of order ea only
} stacked_t;

// Theirs from the first row of a chunk on, and what is formed of it.
typedef struct {
  stacked_t at;
  global real *x, *x_next;  // X and X+; the same place, or not
  int rows, pitch;
} chunk_t;

INLINE chunk_t chunk_at(const stacked_t m, const segment_t s, int row, int end, global real* x,
                        global real* x_next) {
  const size_t first = (s.first_row + row) * s.pitch;
  const stacked_t at = {m.d + first, m.t + first, m.a + first, m.e + first};
  const chunk_t c = {at, x, x_next, min(SWEEP_ROWS, end - row), s.pitch};
  return c;
}

// A of a chunk = left right, `right` with the pitch of the chunk.
typedef struct {
  global const real *left, *right;
  int left_pitch, depth;
} product_t;

// T, where A is known, order ae; returns X+.
INLINE vreal update_ae(const scalars_t k, vreal a, vreal d, global real* t, sums_t* sums) {
  const step_t step = step_ae(k, d, a, load(t));
  sums->squares = fma(step.rest, step.rest, sums->squares);
  sums->sparse = fma(step.sparse, step.sparse, sums->sparse);
  store(t, step.kept);
  return shifted(d, step.kept, k.inverse_mu, k.inverse_next, k.lambda);
}

// The same for order ea: Y.
INLINE vreal update_ea(const scalars_t k, vreal a, vreal d, vreal x, global real* y, sums_t* sums) {
  const step_t step = step_ea(k, x, a, load(y));
  sums->squares = fma(step.rest, step.rest, sums->squares);
  store(y, step.kept);
  return shifted_ea(d, step.kept, a, k.inverse_next, k.lambda);
}

// `whole` as a constant: no row of the tile lies past the end.
INLINE void update_tile(const scalars_t k, const tile_t* a, const chunk_t c, const int order_ea,
                        const int whole, int row, int column, const int width, sums_t* sums) {
  size_t start = row * (size_t)c.pitch + column;
#pragma unroll
  for (int r = 0; r < TILE_ROWS; ++r, start += c.pitch)
#pragma unroll
    for (int v = 0; v < width; ++v)
      if (whole || row + r < c.rows) {
        const size_t i = start + v * VW;
        const vreal d = load(c.at.d + i);
        store(c.x_next + i, order_ea ? update_ea(k, a->at[r][v], d, load(c.x + i), c.at.t + i, sums)
                                     : update_ae(k, a->at[r][v], d, c.at.t + i, sums));
      }
}

// One tile of A and all that follows from it.
INLINE void sweep_tile(const scalars_t k, const chunk_t c, const product_t p, int order_ea,
                       int keep, int row, int column, const int width, sums_t* sums) {
  tile_t a;
  clear_tile(&a, width);
  add_product(&a, p.left, p.left_pitch, p.right, c.pitch, p.depth, row, c.rows, column, width, 0);
  if (keep) store_tile(&a, c.at.a, c.pitch, row, c.rows, column, width);
  if (order_ea)
    update_tile(k, &a, c, 1, 0, row, column, width, sums);
  else if (row + TILE_ROWS <= c.rows)
    update_tile(k, &a, c, 0, 1, row, column, width, sums);
  else
    update_tile(k, &a, c, 0, 0, row, column, width, sums);
}

INLINE void sweep_rows(const scalars_t k, const chunk_t c, const product_t p,
                       global const state_t* state, sums_t* sums) {
  const int order_ea = state->order_ea, keep = state->keep || order_ea;
  int column = 0;
  for (; column + TILE_COLUMNS <= c.pitch; column += TILE_COLUMNS)
    for (int row = 0; row < c.rows; row += TILE_ROWS)
      sweep_tile(k, c, p, order_ea, keep, row, column, TILE_VECTORS, sums);
  for (; column < c.pitch; column += VW)
    for (int row = 0; row < c.rows; row += TILE_ROWS)
      sweep_tile(k, c, p, order_ea, keep, row, column, 1, sums);
}

// X of the chunk, and E of order ea if it may be the last.
INLINE void form_rows(const scalars_t k, const chunk_t c, int order_ea, int keep) {
  for (int i = 0; i < c.rows * c.pitch; i += VW) {
    const vreal d = load(c.at.d + i), t = load(c.at.t + i);
    if (!order_ea) {
      store(c.x + i, shifted(d, t, k.inverse_last, k.inverse_mu, k.lambda));
      continue;
    }
    const vreal a = load(c.at.a + i);
    store(c.x + i, shifted_ea(d, t, a, k.inverse_mu, k.lambda));
    if (keep) store(c.at.e + i, sparse_part(d, t, a, k.inverse_mu, k.lambda));
  }
}

INLINE void project_tile(const chunk_t c, global const real* v, global const real* f,
                         global real* projected, int order, int row, int column, const int width) {
  tile_t tile;
  clear_tile(&tile, width);
  add_product(&tile, c.x, c.pitch, v, c.pitch, order, row, c.rows, column, width, 0);
#pragma unroll
  for (int r = 0; r < TILE_ROWS; ++r)
#pragma unroll
    for (int i = 0; i < width; ++i) tile.at[r][i] *= load(f + column + i * VW);
  store_tile(&tile, projected, c.pitch, row, c.rows, column, width);
}

// B = (XV) diag(f), its columns up to the rank.
INLINE void project(const chunk_t c, global const real* v, global const real* f,
                    global real* projected, int order, int rank) {
  int column = 0;
  for (; column + TILE_COLUMNS < rank + VW; column += TILE_COLUMNS)
    for (int row = 0; row < c.rows; row += TILE_ROWS)
      project_tile(c, v, f, projected, order, row, column, TILE_VECTORS);
  for (; column < rank; column += VW)
    for (int row = 0; row < c.rows; row += TILE_ROWS)
      project_tile(c, v, f, projected, order, row, column, 1);
}

// A = XW.
kernel void sweep_full(global const segment_t* segments,  // [segments]
                       global const block_t* blocks,      // [block_count]
                       int block_count,
                       global const state_t* states,  // [segments]
                       global const real* data,       // D [rows x pitch] stacked
                       global real* t,                // T -> T, or Y -> Y+
                       global real* a,                // A, where it is kept or needed
                       global real* e,                // E, order ea only
                       global const real* w,          // order x order matrices
                       global real* scratch,          // [block_count x 2 SWEEP_ROWS x pitch]
                       int with_gram,   // 0 also where it takes another number type than X
                       global real* g,  // order x order matrices: of the first blocks
                       global real* partial_grams,  // order x order matrices: of the other blocks
                       global report_t* reports) {  // [all blocks]
  const int item = get_global_id(0);
  if (item >= block_count) return;
  const block_t block = blocks[item];
  const segment_t s = segments[block.segment];
  global const state_t* state = states + block.segment;
  if (state->finished || state->low_rank || is_wide(s)) return;
  const scalars_t k = scalars_of(state);
  const stacked_t m = {data, t, a, e};
  global real* gram = gram_of(block, s, g, partial_grams);
  global real* x = scratch + item * (size_t)(2 * SWEEP_ROWS) * s.pitch;
  global real* x_next = x + SWEEP_ROWS * (size_t)s.pitch;
  const product_t low_rank_part = {x, w + s.square, s.pitch, s.order};
  const int begin = block_begin(block, s), end = block_end(block, s);
  sums_t sums = {0, 0};
  for (int row = begin; row < end; row += SWEEP_ROWS) {
    const chunk_t c = chunk_at(m, s, row, end, x, x_next);
    form_rows(k, c, state->order_ea, state->keep);
    sweep_rows(k, c, low_rank_part, state, &sums);
    if (with_gram) add_gram(x_next, gram, row == begin, s, c.rows);
  }
  reports[s.first_block + block.block] = report_of(sums, k);
}

// A = B V' with B = (XV) diag(f); X+ takes the place of X.
kernel void sweep_low_rank(
    global const segment_t* segments,  // [segments]
    global const block_t* blocks,      // [block_count]
    int block_count,
    global const state_t* states,  // [segments]
    global const real* data,       // D [rows x pitch] stacked
    global real* t,                // T -> T, or Y -> Y+
    global real* a,                // A, where it is kept or needed
    global real* e,                // E, order ea only
    global const real* v,          // order x order matrices: vectors in columns
    global const real* f,          // `order` per segment
    global const real* z,          // order x order matrices: V', vectors in rows
    global real* scratch,          // [block_count x 2 SWEEP_ROWS x pitch]
    int with_gram,                 // 0 also where it takes another number type than X
    global real* g,                // order x order matrices: of the first blocks
    global real* partial_grams,    // order x order matrices: of the other blocks
    global report_t* reports) {    // [all blocks]
  const int item = get_global_id(0);
  if (item >= block_count) return;
  const block_t block = blocks[item];
  const segment_t s = segments[block.segment];
  global const state_t* state = states + block.segment;
  if (state->finished || !state->low_rank) return;
  const scalars_t k = scalars_of(state);
  const stacked_t m = {data, t, a, e};
  global real* gram = gram_of(block, s, g, partial_grams);
  global real* x = scratch + item * (size_t)(2 * SWEEP_ROWS) * s.pitch;
  global real* projected = x + SWEEP_ROWS * (size_t)s.pitch;
  const product_t low_rank_part = {projected, z + s.square, s.pitch, state->rank};
  const int begin = block_begin(block, s), end = block_end(block, s);
  sums_t sums = {0, 0};
  for (int row = begin; row < end; row += SWEEP_ROWS) {
    const chunk_t c = chunk_at(m, s, row, end, x, x);
    form_rows(k, c, state->order_ea, state->keep);
    project(c, v + s.square, f + s.vector, projected, s.order, state->rank);
    sweep_rows(k, c, low_rank_part, state, &sums);
    if (with_gram) add_gram(x, gram, row == begin, s, c.rows);
  }
  reports[s.first_block + block.block] = report_of(sums, k);
}

// A = WX; its Gram matrix is that of X as a whole.
kernel void sweep_wide(global const segment_t* segments,  // [segments]
                       global const block_t* blocks,      // [block_count]
                       int block_count,
                       global const state_t* states,  // [segments]
                       global const real* data,       // D [rows x pitch] stacked
                       global real* t,                // T -> T, or Y -> Y+
                       global real* a,                // A, where it is kept or needed
                       global real* e,                // E, order ea only
                       global const real* w,          // order x order matrices
                       global const real* x,          // X [rows x pitch] stacked
                       global real* scratch,          // [block_count x 2 SWEEP_ROWS x pitch]
                       global report_t* reports) {    // [all blocks]
  const int item = get_global_id(0);
  if (item >= block_count) return;
  const block_t block = blocks[item];
  const segment_t s = segments[block.segment];
  global const state_t* state = states + block.segment;
  if (state->finished || !is_wide(s)) return;
  const scalars_t k = scalars_of(state);
  const stacked_t m = {data, t, a, e};
  global real* own = scratch + item * (size_t)(2 * SWEEP_ROWS) * s.pitch;
  const int begin = block_begin(block, s), end = block_end(block, s);
  sums_t sums = {0, 0};
  for (int row = begin; row < end; row += SWEEP_ROWS) {
    const chunk_t c = chunk_at(m, s, row, end, own, own);
    const product_t low_rank_part = {w + s.square + row * (size_t)s.order_pitch,
                                     x + s.first_row * s.pitch, s.order_pitch, s.order};
    form_rows(k, c, state->order_ea, state->keep);
    sweep_rows(k, c, low_rank_part, state, &sums);
  }
  reports[s.first_block + block.block] = report_of(sums, k);
}

kernel void start(global const segment_t* segments,  // [segments]
                  global const block_t* blocks,      // [block_count]
                  int block_count,
                  global const state_t* states,  // [segments]
                  global const real* data,       // D [rows x pitch] stacked
                  int with_missing,
                  global const real* observed,  // 0 where D is missing, and filled; else 1
                  global real* t,               // Y = dual_scale D, |Y| <= lambda; 0 where missing
                  global real* a) {             // A = 0, order ea only; D where missing
  const int item = get_global_id(0);
  if (item >= block_count) return;
  const segment_t s = segments[blocks[item].segment];
  global const state_t* state = states + blocks[item].segment;
  const entries_t entries = entries_of(blocks[item], s);
  const real dual_scale = state->dual_scale;
  for (size_t i = entries.first; i < entries.last; i += VW) {
    const vreal d = load(data + i), seen = with_missing ? load(observed + i) : (vreal)1;
    store(t + i, first_dual(d, seen, dual_scale));
    if (state->order_ea) store(a + i, first_low_rank(d, seen));
  }
}

kernel void form(global const segment_t* segments,  // [segments]
                 global const block_t* blocks,      // [block_count]
                 int block_count,
                 global const state_t* states,  // [segments]
                 int wide_only,
                 global const real* data,  // D [rows x pitch] stacked
                 global real* t,           // T, or Y
                 global real* a,           // A, order ea only
                 global real* e,           // E, order ea only
                 global real* x) {         // X
  const int item = get_global_id(0);
  if (item >= block_count) return;
  const segment_t s = segments[blocks[item].segment];
  global const state_t* state = states + blocks[item].segment;
  if (state->finished || (wide_only && !is_wide(s))) return;
  const stacked_t m = {data, t, a, e};
  const int end = block_end(blocks[item], s);
  for (int row = block_begin(blocks[item], s); row < end; row += SWEEP_ROWS) {
    const chunk_t c = chunk_at(m, s, row, end, x + (s.first_row + row) * s.pitch, 0);
    form_rows(scalars_of(state), c, state->order_ea, 1);
  }
}

kernel void shrink(global const segment_t* segments,  // [segments]
                   global const block_t* blocks,      // [block_count]
                   int block_count,
                   global const state_t* states,  // [segments]
                   global real* data,             // D [rows x pitch] stacked
                   int with_missing,              // D becomes A where it is missing
                   global const real* observed,   // 0 where D is missing, else 1
                   global const real* x,          // X
                   global const real* a,          // A
                   global real* t,                // T -> T, or Y -> Y+
                   global report_t* reports) {    // [all blocks]
  const int item = get_global_id(0);
  if (item >= block_count) return;
  const segment_t s = segments[blocks[item].segment];
  global const state_t* state = states + blocks[item].segment;
  if (state->finished) return;
  const scalars_t k = scalars_of(state);
  const entries_t entries = entries_of(blocks[item], s);
  sums_t sums = {0, 0};
  for (size_t i = entries.first; i < entries.last; i += VW) {
    const vreal known = load(a + i);
    vreal d = load(data + i), formed = load(x + i);
    if (with_missing) {
      const vreal seen = load(observed + i);
      d = observed_or(seen, d, known);
      formed = observed_or(seen, formed, known);
      store(data + i, d);
    }
    if (state->order_ea)
      update_ea(k, known, d, formed, t + i, &sums);
    else
      update_ae(k, known, d, t + i, &sums);
  }
  reports[s.first_block + blocks[item].block] = report_of(sums, k);
}

kernel void finish(global const segment_t* segments,  // [segments]
                   global const block_t* blocks,      // [block_count]
                   int block_count,
                   global const state_t* states,  // [segments]
                   global const real* e,          // E, order ea only
                   global real* t) {              // T, or Y -> E
  const int item = get_global_id(0);
  if (item >= block_count) return;
  const segment_t s = segments[blocks[item].segment];
  global const state_t* state = states + blocks[item].segment;
  const entries_t entries = entries_of(blocks[item], s);
  const real inverse_last = state->inverse_last, lambda = state->lambda;
  for (size_t i = entries.first; i < entries.last; i += VW)
    store(t + i,
          state->order_ea ? load(e + i) : last_sparse_part(load(t + i), inverse_last, lambda));
}
