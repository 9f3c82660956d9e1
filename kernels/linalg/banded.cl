// Symmetric positive definite band matrices along time: one system per column of a segment, its
// unknowns the rows. WIDTH is the half-bandwidth w and the order of the difference Delta over the
// rows of a segment (free ends: no rows beyond them).
//
//   assemble   A = diag(W) + q Delta'Delta
//   factor     A = L D L', in place: L(i, i - k) in band k, 1/D(i) in band 0
//   solve      L D L' x = b, b and x may be the same buffer
//   penalise   y = Delta'Delta x
//
// Band k holds the entries (i, i - k), zero for i < k. A factor per column has its bands as stacked
// matrices one after the other; a factor shared by the columns of a segment as WIDTH + 1 numbers
// per row. A pivot that is not positive counts as infinite, so that padding stays zero.
//
// Launch: (vectors of columns, active segments); `shared` factors: one work-item per active
// segment; penalise: one work-item per block of rows.

#include "linalg/load_rows.cl"

#ifndef WIDTH
#error "WIDTH is not defined: half-bandwidth, 1, 2 or 3"
#endif

#if WIDTH == 1
constant real difference[] = {-1, 1};
#elif WIDTH == 2
constant real difference[] = {1, -2, 1};
#else
constant real difference[] = {-1, 3, -3, 1};
#endif

// The entry (row, row - k) of Delta'Delta for so many rows: over the differences that touch both.
inline real penalty_entry(int row, int k, int rows) {
  real entry = 0;
  for (int j = max(k, row + WIDTH + 1 - rows); j <= min(WIDTH, row); ++j)
    entry += difference[j] * difference[j - k];
  return entry;
}

// The bands of one vector of columns, or those its segment shares. `shared` is a constant.
typedef struct {
  global real* first;
  uint to_next_row;
  size_t to_next_band;
} bands_t;

// Band k of `count` rows from `row` on, down (step 1) or up (step -1); count is a constant.
INLINE void load_band(vreal* rows, const bands_t m, const int shared, int row, int k,
                      const int step, const int count) {
  global const real* p = m.first + k * m.to_next_band;
  const int to_next = step * (int)m.to_next_row;
  const uint at = row * m.to_next_row;
  if (!shared) load_rows(rows, p, at, to_next, count);
#pragma unroll ROWS
  for (int i = 0; shared && i < count; ++i) rows[i] = p[(uint)(at + i * to_next)];
}

INLINE void set_band(const bands_t m, const int shared, int row, int k, vreal value) {
  global real* p = m.first + k * m.to_next_band + (uint)(row * m.to_next_row);
  if (shared)
    *p = lane_max(value);  // all are the same
  else
    store(p, value);
}

INLINE bands_t bands_of(const segment_t s, const int shared, int column, long to_next_band,
                        global real* bands) {
  const bands_t own = {bands + s.first_row * s.pitch + column, s.pitch, to_next_band};
  const bands_t common = {bands + s.first_row * (WIDTH + 1), WIDTH + 1, 1};
  return shared ? common : own;
}

INLINE void assemble(const bands_t a, const int shared, const segment_t s,
                     global const real* weights, size_t to_next_weight, vreal q) {
  for (int i = 0; i < s.rows; ++i) {
    const vreal w = shared ? (vreal)*weights : load(weights + i * to_next_weight);
    set_band(a, shared, i, 0, fma(q, (vreal)penalty_entry(i, 0, s.rows), w));
    for (int k = 1; k <= WIDTH; ++k)
      set_band(a, shared, i, k, q * (i < k ? 0 : penalty_entry(i, k, s.rows)));
  }
}

INLINE vreal inverse_pivot(vreal pivot) { return pivot > 0 ? 1 / pivot : 0; }

// The rows of a factorization before the next one, the nearest first.
typedef struct {
  vreal l1, l2, m1, inverse1, inverse2, inverse3;  // l, m: of the rows before, one and two
} pivots_t;

// `count` rows from row i on: u_k = L(i, i - k) D(i - k), from the farthest entry on.
INLINE void factor_rows(const bands_t a, const int shared, int i, const int count, pivots_t* p) {
  vreal pivots[ROWS], near[ROWS], middle[ROWS], far[ROWS];
  load_band(pivots, a, shared, i, 0, 1, count);
  load_band(near, a, shared, i, 1, 1, count);
  if (WIDTH > 1) load_band(middle, a, shared, i, 2, 1, count);
  if (WIDTH > 2) load_band(far, a, shared, i, 3, 1, count);
#pragma unroll ROWS
  for (int k = 0; k < count; ++k) {
    vreal pivot = pivots[k], u1 = near[k], u2 = 0, u3 = 0;
    if (WIDTH > 1) u2 = middle[k];
    if (WIDTH > 2) {
      u3 = far[k];
      u2 = fma(-u3, p->m1, u2);
      u1 = fma(-u3, p->l2, u1);
    }
    if (WIDTH > 1) u1 = fma(-u2, p->l1, u1);
    p->m1 = p->l1;
    if (WIDTH > 2) {
      const vreal l3 = u3 * p->inverse3;
      pivot = fma(-u3, l3, pivot);
      set_band(a, shared, i + k, 3, l3);
    }
    if (WIDTH > 1) {
      p->l2 = u2 * p->inverse2;
      pivot = fma(-u2, p->l2, pivot);
      set_band(a, shared, i + k, 2, p->l2);
    }
    p->l1 = u1 * p->inverse1;
    pivot = fma(-u1, p->l1, pivot);
    set_band(a, shared, i + k, 1, p->l1);
    p->inverse3 = p->inverse2;
    p->inverse2 = p->inverse1;
    p->inverse1 = inverse_pivot(pivot);
    set_band(a, shared, i + k, 0, p->inverse1);
  }
}

INLINE void factor(const bands_t a, const int shared, int rows) {
  pivots_t p = {0, 0, 0, 0, 0, 0};
  int i = 0;
  for (; i + ROWS <= rows; i += ROWS) factor_rows(a, shared, i, ROWS, &p);
  for (; i < rows; ++i) factor_rows(a, shared, i, 1, &p);
}

// The three rows solved last stay in registers, and of the rows below what leads to those above.
typedef struct {
  vreal x1, x2, x3, l1, l2, l3, next2, next3, nearest3;
} walk_t;

// `count` rows of L z = b from row i on.
INLINE void rows_downwards(const bands_t l, const int shared, int pitch, int i, const int count,
                           global const real* b, global real* x, walk_t* w) {
  vreal right[ROWS], near[ROWS], middle[ROWS], far[ROWS];
  load_rows(right, b, i * pitch, pitch, count);
  load_band(near, l, shared, i, 1, 1, count);
  if (WIDTH > 1) load_band(middle, l, shared, i, 2, 1, count);
  if (WIDTH > 2) load_band(far, l, shared, i, 3, 1, count);
#pragma unroll ROWS
  for (int k = 0; k < count; ++k) {
    vreal z = right[k];
    if (WIDTH > 2) z = fma(-far[k], w->x3, z);
    if (WIDTH > 1) z = fma(-middle[k], w->x2, z);
    z = fma(-near[k], w->x1, z);
    w->x3 = w->x2;
    w->x2 = w->x1;
    w->x1 = z;
    store(x + (uint)((i + k) * pitch), z);
  }
}

// `count` rows of L' x = z / D from row i up.
INLINE void rows_upwards(const bands_t l, const int shared, int pitch, int i, const int count,
                         global real* x, walk_t* w) {
  vreal right[ROWS], inverse[ROWS], near[ROWS], middle[ROWS], far[ROWS];
  load_rows(right, x, i * pitch, -pitch, count);
  load_band(inverse, l, shared, i, 0, -1, count);
  load_band(near, l, shared, i, 1, -1, count);
  if (WIDTH > 1) load_band(middle, l, shared, i, 2, -1, count);
  if (WIDTH > 2) load_band(far, l, shared, i, 3, -1, count);
#pragma unroll ROWS
  for (int k = 0; k < count; ++k) {
    vreal z = right[k] * inverse[k];
    if (WIDTH > 2) z = fma(-w->l3, w->x3, z);
    if (WIDTH > 1) z = fma(-w->l2, w->x2, z);
    z = fma(-w->l1, w->x1, z);
    w->x3 = w->x2;
    w->x2 = w->x1;
    w->x1 = z;
    store(x + (uint)((i - k) * pitch), z);
    // The row above takes L(i, i - 1), L(i + 1, i - 1) and L(i + 2, i - 1).
    w->l1 = near[k];
    if (WIDTH > 1) {
      w->l2 = w->next2;
      w->next2 = middle[k];
    }
    if (WIDTH > 2) {
      w->l3 = w->nearest3;
      w->nearest3 = w->next3;
      w->next3 = far[k];
    }
  }
}

// L z = b down the rows, L' x = z / D up again.
INLINE void solve(const bands_t l, const int shared, const segment_t s, global const real* b,
                  global real* x) {
  const walk_t begin = {0, 0, 0, 0, 0, 0, 0, 0, 0};
  walk_t w = begin;
  int i = 0;
  for (; i + ROWS <= s.rows; i += ROWS) rows_downwards(l, shared, s.pitch, i, ROWS, b, x, &w);
  for (; i < s.rows; ++i) rows_downwards(l, shared, s.pitch, i, 1, b, x, &w);
  w = begin;
  int left = s.rows;
  for (; left >= ROWS; left -= ROWS) rows_upwards(l, shared, s.pitch, left - 1, ROWS, x, &w);
  for (; left > 0; --left) rows_upwards(l, shared, s.pitch, left - 1, 1, x, &w);
}

kernel void assemble_columns(global const segment_t* segments,  // [segments]
                             global const int* active,          // [active segments]
                             long to_next_band,                 // reals of a stacked matrix
                             global const real* weights,        // W, [rows x pitch] stacked
                             global const real* penalties,      // q, [segments x pitch]
                             global real* bands) {              // [WIDTH + 1] stacked matrices
  const int b = active[get_global_id(1)], column = get_global_id(0) * VW;
  const segment_t s = segments[b];
  if (column >= s.pitch) return;
  assemble(bands_of(s, 0, column, to_next_band, bands), 0, s,
           weights + s.first_row * s.pitch + column, s.pitch,
           load(penalties + b * (size_t)s.pitch + column));
}

kernel void factor_columns(global const segment_t* segments,  // [segments]
                           global const int* active,          // [active segments]
                           long to_next_band,                 // reals of a stacked matrix
                           global real* bands) {              // [WIDTH + 1] stacked matrices
  const segment_t s = segments[active[get_global_id(1)]];
  const int column = get_global_id(0) * VW;
  if (column >= s.pitch) return;
  factor(bands_of(s, 0, column, to_next_band, bands), 0, s.rows);
}

kernel void solve_columns(global const segment_t* segments,  // [segments]
                          global const int* active,          // [active segments]
                          long to_next_band,                 // reals of a stacked matrix
                          global real* bands,                // the factor, as above
                          global const real* b,              // [rows x pitch] stacked
                          global real* x) {                  // [rows x pitch] stacked
  const segment_t s = segments[active[get_global_id(1)]];
  const int column = get_global_id(0) * VW;
  if (column >= s.pitch) return;
  const size_t first = s.first_row * s.pitch + column;
  solve(bands_of(s, 0, column, to_next_band, bands), 0, s, b + first, x + first);
}

kernel void factor_shared(global const segment_t* segments,  // [segments]
                          global const int* active,          // [active_count]
                          int active_count,
                          global const real* weights,    // c in A = c I + q Delta'Delta, [segments]
                          global const real* penalties,  // q, [segments]
                          global real* bands) {          // [rows x (WIDTH + 1)]
  const int item = get_global_id(0);
  if (item >= active_count) return;
  const int b = active[item];
  const bands_t a = bands_of(segments[b], 1, 0, 0, bands);
  assemble(a, 1, segments[b], weights + b, 0, penalties[b]);
  factor(a, 1, segments[b].rows);
}

kernel void solve_shared(global const segment_t* segments,  // [segments]
                         global const int* active,          // [active segments]
                         global real* bands,                // [rows x (WIDTH + 1)], the factor
                         global const real* b,              // [rows x pitch] stacked
                         global real* x) {                  // [rows x pitch] stacked
  const segment_t s = segments[active[get_global_id(1)]];
  const int column = get_global_id(0) * VW;
  if (column >= s.pitch) return;
  const size_t first = s.first_row * s.pitch + column;
  solve(bands_of(s, 1, 0, 0, bands), 1, s, b + first, x + first);
}

// One row of Delta'Delta x from the rows around it; those beyond the ends have weight 0.
INLINE void penalise_row(const segment_t s, int row, global const real* x, global real* y) {
  real weights[2 * WIDTH + 1];
  global const real* rows[2 * WIDTH + 1];
#pragma unroll
  for (int k = -WIDTH; k <= WIDTH; ++k) {
    const int inside = row + k >= 0 && row + k < s.rows;
    weights[k + WIDTH] = inside ? penalty_entry(row + max(k, 0), abs(k), s.rows) : 0;
    rows[k + WIDTH] = x + (inside ? row + k : row) * (size_t)s.pitch;
  }
  for (int column = 0; column < s.pitch; column += VW) {
    vreal sum = 0;
#pragma unroll
    for (int k = 0; k <= 2 * WIDTH; ++k) sum = fma((vreal)weights[k], load(rows[k] + column), sum);
    store(y + row * (size_t)s.pitch + column, sum);
  }
}

kernel void penalise(global const segment_t* segments,  // [segments]
                     global const block_t* blocks,      // [block_count]
                     int block_count,
                     global const real* x,  // [rows x pitch] stacked
                     global real* y) {      // [rows x pitch] stacked, another buffer
  const int item = get_global_id(0);
  if (item >= block_count) return;
  const block_t block = blocks[item];
  const segment_t s = segments[block.segment];
  const size_t first = s.first_row * s.pitch;
  for (int row = block_begin(block, s); row < block_end(block, s); ++row)
    penalise_row(s, row, x + first, y + first);
}
