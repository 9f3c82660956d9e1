// Preconditioned conjugate gradients for W o S + Delta'P Delta S R = W o D, Delta the second
// difference over the rows of a segment, P a diagonal of their precisions, R symmetric positive
// definite [columns x columns]; one system per segment, in the notation of
// host/moclean/methods/matrix_normal/reference.cpp:
//
//   factor      M = diag(W_j + least) + R_jj Delta'P Delta = L diag(pivot) L' per column j
//   direction   p = z + beta p,  q = W o p + Delta'P Delta p R,  p.q per block: search_direction.cl
//   start       r = W o D - q,   z = M^-1 r,  r.z and b.M^-1 b for b = W o D per vector of columns
//   update      S += alpha p,  r -= alpha q,  z = M^-1 r,  r.z per vector of columns
//
// A segment whose r.z has come down to `tolerance`^2 of b.M^-1 b is left as it is.
// Every L has two bands; the second is P R_jj / pivot two rows up, and is not stored.
//
// Launch: (vectors of columns, active segments). With vectors of one real neighbouring work-items
// read neighbouring reals, as a GPU likes it.

#include "linalg/load_rows.cl"
#include "matrix_normal/conjugate_sums.cl"

#define AHEAD 12  // rows from a row to what is fetched for the recurrences below or above it

// One vector of columns of a segment, and its L.
typedef struct {
  size_t begin;  // its first entry among those of all segments
  uint pitch;
  int rows;
  global const real *precisions, *inverse_pivot, *first_band;  // of its first row
  vreal q;                                                     // R_jj
} column_t;

INLINE column_t column_of(const segment_t s, int column, global const real* precisions,
                          global const real* stiffness, global const real* inverse_pivot,
                          global const real* first_band) {
  column_t c;
  c.begin = s.first_row * s.pitch + column;
  c.pitch = s.pitch;
  c.rows = s.rows;
  c.precisions = precisions + s.first_row;
  c.inverse_pivot = inverse_pivot + c.begin;
  c.first_band = first_band + c.begin;
  c.q = load(stiffness + s.vector + column);
  return c;
}

// What a walk over rows needs of L: L(i + 1, i) belongs to row i + 1, L(i + 2, i) to row i.
typedef struct {
  vreal inverse[ROWS], first[ROWS], second[ROWS];
} factor_t;

// Of `count` rows from row i on, down (step 1) or up (step -1).
INLINE void load_factor(factor_t* f, const column_t c, int i, const int step, const int count) {
  load_rows(f->inverse, c.inverse_pivot, i * c.pitch, step * (int)c.pitch, count);
  load_rows(f->first, c.first_band, i * c.pitch, step * (int)c.pitch, count);
#pragma unroll ROWS
  for (int k = 0; k < count; ++k) f->second[k] = c.precisions[i + k * step] * c.q * f->inverse[k];
}

// The last two rows of a walk: y or z, and the entries of L that lead from them.
typedef struct {
  vreal value1, value2, first1, second1, second2;
} walk_t;

// `count` rows of y = L^-1 r.
INLINE void rows_downwards(const column_t c, const factor_t* f, const vreal* r, uint at,
                           const int count, global real* z, walk_t* w) {
#pragma unroll ROWS
  for (int k = 0; k < count; ++k, at += c.pitch) {
    const vreal y = fma(-f->first[k], w->value1, fma(-w->second2, w->value2, r[k]));
    store(z + at, y);
    w->value2 = w->value1;
    w->value1 = y;
    w->second2 = w->second1;
    w->second1 = f->second[k];
  }
}

// `count` rows of z = L'^-1 diag(1 / pivot) y from row i up; adds to the sum of r z.
INLINE void rows_upwards(const column_t c, int i, const int count, global const real* r,
                         global real* z, walk_t* w, vreal* sum) {
  uint at = i * c.pitch;
  const uint next = at - min(AHEAD, i) * c.pitch;
  PREFETCH(c.inverse_pivot + next);
  PREFETCH(z + next);
  PREFETCH(c.first_band + next);
  PREFETCH(r + next);
  factor_t f;
  load_factor(&f, c, i, -1, count);
  vreal y[ROWS], rest[ROWS];
  load_rows(y, z, at, -(int)c.pitch, count);
  load_rows(rest, r, at, -(int)c.pitch, count);
#pragma unroll ROWS
  for (int k = 0; k < count; ++k, at -= c.pitch) {
    const vreal part = fma(-f.second[k], w->value2, y[k] * f.inverse[k]);
    const vreal value = fma(-w->first1, w->value1, part);
    store(z + at, value);
    *sum = fma(rest[k], value, *sum);
    w->value2 = w->value1;
    w->value1 = value;
    w->first1 = f.first[k];
  }
}

// From the last row on; returns the sum of r z.
INLINE vreal solve_upwards(const column_t c, global const real* r, global real* z) {
  walk_t w = {0, 0, 0, 0, 0};
  vreal sum = 0;
  int left = c.rows;
  for (; left >= ROWS; left -= ROWS) rows_upwards(c, left - 1, ROWS, r, z, &w, &sum);
  for (; left > 0; --left) rows_upwards(c, left - 1, 1, r, z, &w, &sum);
  return sum;
}

// The last two rows of a factorization.
typedef struct {
  vreal inverse1, inverse2, l;
  real c1, c2;  // precisions
} pivots_t;

// `count` rows from row i on.
INLINE void factor_rows(const column_t c, int i, const int count, global const real* weights,
                        real least, global real* inverse_pivot, global real* first_band,
                        pivots_t* p) {
  uint at = i * c.pitch;
  vreal weight[ROWS];
  real precision[ROWS];
  load_rows(weight, weights, at, c.pitch, count);
#pragma unroll ROWS
  for (int k = 0; k < count; ++k) precision[k] = c.precisions[i + k];
#pragma unroll ROWS
  for (int k = 0; k < count; ++k, at += c.pitch) {
    const real c0 = precision[k], c1 = p->c1, c2 = p->c2;
    const vreal q2 = c2 * c.q;                           // L(i, i - 2) pivot(i - 2)
    const vreal u = c.q * (-2 * (c1 + c2)) - q2 * p->l;  // L(i, i - 1) pivot(i - 1)
    p->l = u * p->inverse1;
    vreal pivot = weight[k] + least + (c0 + 4 * c1 + c2) * c.q;
    pivot -= u * p->l + q2 * q2 * p->inverse2;
    p->inverse2 = p->inverse1;
    p->inverse1 = 1 / pivot;
    store(inverse_pivot + at, p->inverse1);
    store(first_band + at, p->l);
    p->c2 = c1;
    p->c1 = c0;
  }
}

kernel void factor(global const segment_t* segments,  // [segments]
                   global const int* active,          // [active segments]
                   global const real* weights,        // W, [rows x pitch] stacked
                   global const real* precisions,     // P, one per row, stacked
                   global const real* stiffness,      // R_jj, one vector per segment
                   global const real* least,          // [segments]
                   global real* inverse_pivot,        // [rows x pitch] stacked
                   global real* first_band) {         // [rows x pitch] stacked
  const int b = active[get_global_id(1)], column = get_global_id(0) * VW;
  const segment_t s = segments[b];
  if (column >= s.pitch) return;
  const column_t c = column_of(s, column, precisions, stiffness, inverse_pivot, first_band);
  weights += c.begin;
  inverse_pivot += c.begin;
  first_band += c.begin;
  pivots_t p = {0, 0, 0, 0, 0};
  int i = 0;
  for (; i + ROWS <= s.rows; i += ROWS)
    factor_rows(c, i, ROWS, weights, least[b], inverse_pivot, first_band, &p);
  for (; i < s.rows; ++i) factor_rows(c, i, 1, weights, least[b], inverse_pivot, first_band, &p);
}

// What r is made of: W o D `at_zero`, a constant, r - product else.
typedef struct {
  global const real *weights, *data, *product;
} start_t;

// `count` rows of r and of y = L^-1 r.
INLINE void start_rows(const column_t c, const start_t m, int i, const int count, const int at_zero,
                       global real* r, global real* z, walk_t* w) {
  const uint at = i * c.pitch;
  factor_t f;
  load_factor(&f, c, i, 1, count);
  vreal a[ROWS], b[ROWS], rest[ROWS];
  load_rows(a, at_zero ? m.weights : r, at, c.pitch, count);
  load_rows(b, at_zero ? m.data : m.product, at, c.pitch, count);
#pragma unroll ROWS
  for (int k = 0; k < count; ++k) {
    rest[k] = at_zero ? a[k] * b[k] : a[k] - b[k];
    store(r + (uint)(at + k * c.pitch), rest[k]);
  }
  rows_downwards(c, &f, rest, at, count, z, w);
}

// z = M^-1 r; returns r.z.
INLINE vreal start_column(const column_t c, const start_t m, const int at_zero, global real* r,
                          global real* z) {
  walk_t w = {0, 0, 0, 0, 0};
  int i = 0;
  for (; i + ROWS <= c.rows; i += ROWS) start_rows(c, m, i, ROWS, at_zero, r, z, &w);
  for (; i < c.rows; ++i) start_rows(c, m, i, 1, at_zero, r, z, &w);
  return solve_upwards(c, r, z);
}

kernel void start(global const segment_t* segments,  // [segments]
                  global const int* active,          // [active segments]
                  global const real* data,           // D, [rows x pitch] stacked
                  global const real* weights,        // W, [rows x pitch] stacked
                  global const real* precisions,     // P, one per row, stacked
                  global const real* stiffness,      // R_jj, one vector per segment
                  global const real* inverse_pivot,  // [rows x pitch] stacked
                  global const real* first_band,     // [rows x pitch] stacked
                  global const real* product,        // q = W o S + Delta'P Delta S R, stacked
                  global real* r,                    // [rows x pitch] stacked
                  global real* z,                    // [rows x pitch] stacked
                  global double* rz,                 // [segments x vectors of columns]
                  global double* bz) {               // [segments x vectors of columns]
  const int b = active[get_global_id(1)], column = get_global_id(0) * VW;
  const segment_t s = segments[b];
  if (column >= s.pitch) return;
  const column_t c = column_of(s, column, precisions, stiffness, inverse_pivot, first_band);
  const size_t place = b * (s.pitch / VW) + column / VW;
  const start_t m = {weights + c.begin, data + c.begin, product + c.begin};
  bz[place] = lane_sum(start_column(c, m, 1, r + c.begin, z + c.begin));
  rz[place] = lane_sum(start_column(c, m, 0, r + c.begin, z + c.begin));
}

// What an update works on, each from the first row of a column on.
typedef struct {
  global const real *p, *product;
  global real *motion, *r, *z;
} update_t;

// `count` rows of S, r and y = L^-1 r.
INLINE void update_rows(const column_t c, const update_t m, int i, const int count, vreal alpha,
                        walk_t* w) {
  const uint at = i * c.pitch, next = at + AHEAD * c.pitch;
  PREFETCH(m.motion + next);
  PREFETCH(m.p + next);
  PREFETCH(m.product + next);
  PREFETCH(m.r + next);
  PREFETCH(m.z + next);
  PREFETCH(c.first_band + next);
  PREFETCH(c.inverse_pivot + next);
  factor_t f;
  load_factor(&f, c, i, 1, count);
  vreal p[ROWS], product[ROWS], motion[ROWS], rest[ROWS];
  load_rows(p, m.p, at, c.pitch, count);
  load_rows(product, m.product, at, c.pitch, count);
  load_rows(motion, m.motion, at, c.pitch, count);
  load_rows(rest, m.r, at, c.pitch, count);
#pragma unroll ROWS
  for (int k = 0; k < count; ++k) {
    const uint row = at + k * c.pitch;
    store(m.motion + row, fma(alpha, p[k], motion[k]));
    rest[k] = fma(-alpha, product[k], rest[k]);
    store(m.r + row, rest[k]);
  }
  rows_downwards(c, &f, rest, at, count, m.z, w);
}

kernel void update(global const segment_t* segments,       // [segments]
                   global const int* active,               // [active segments]
                   global const real* precisions,          // P, one per row, stacked
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
  const size_t place = b * (s.pitch / VW) + column / VW;
  const double squares = sum_of_vectors(rz, b, s);
  rz_next[place] = rz[place];
  if (is_enough(squares, bz, b, s, tolerance)) return;
  double pq = 0;
  for (int i = 0; i < block_count_of(s); ++i) pq += partial_pq[s.first_block + i];
  const vreal alpha = squares / pq;
  const column_t c = column_of(s, column, precisions, stiffness, inverse_pivot, first_band);
  const update_t m = {p + c.begin, product + c.begin, motion + c.begin, r + c.begin, z + c.begin};
  walk_t w = {0, 0, 0, 0, 0};
  int i = 0;
  for (; i + ROWS <= s.rows; i += ROWS) update_rows(c, m, i, ROWS, alpha, &w);
  for (; i < s.rows; ++i) update_rows(c, m, i, 1, alpha, &w);
  rz_next[place] = lane_sum(solve_upwards(c, m.r, m.z));
}
