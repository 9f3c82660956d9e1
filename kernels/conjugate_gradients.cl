// Preconditioned conjugate gradients for W o S + Delta'P Delta S R = W o D, Delta the second
// difference over the rows of a segment, P a diagonal of their precisions, R symmetric positive
// definite [columns x columns]; one system per segment, in the notation of
// host/moclean/solve/reference/matrix_normal.cpp:
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

#include "conjugate_sums.cl"

#define AHEAD 12  // rows from a row to what is fetched for the recurrences below or above it

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
  const vreal q = load(stiffness + s.vector + column);
  size_t at = s.first_row * s.pitch + column;
  vreal inverse1 = 0, inverse2 = 0, l = 0;
  for (int i = 0; i < s.rows; ++i, at += s.pitch) {
    const real c0 = precision_at(precisions, s, i), c1 = precision_at(precisions, s, i - 1);
    const real c2 = precision_at(precisions, s, i - 2);
    const vreal q2 = c2 * q;                        // L(i, i - 2) pivot(i - 2)
    const vreal u = q * (-2 * (c1 + c2)) - q2 * l;  // L(i, i - 1) pivot(i - 1)
    l = u * inverse1;
    vreal pivot = load(weights + at) + least[b] + (c0 + 4 * c1 + c2) * q;
    pivot -= u * l + q2 * q2 * inverse2;
    inverse2 = inverse1;
    inverse1 = 1 / pivot;
    store(inverse_pivot + at, inverse1);
    store(first_band + at, l);
  }
}

// z = L'^-1 diag(1 / pivot) y from the last row on; returns the sum of r z.
INLINE vreal solve_upwards(const segment_t s, global const real* precisions, vreal q, size_t begin,
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
    const vreal l2 = precision_at(precisions, s, i) * q * inverse;  // L(i + 2, i)
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

INLINE vreal solve_downwards(const segment_t s, global const real* precisions, vreal q,
                             size_t begin, global const real* inverse_pivot,
                             global const real* first_band, global const real* r, global real* z) {
  vreal y1 = 0, y2 = 0, inverse1 = 0, inverse2 = 0;
  size_t at = begin;
  for (int i = 0; i < s.rows; ++i, at += s.pitch) {
    const vreal l2 = precision_at(precisions, s, i - 2) * q * inverse2;
    const vreal y = next_downwards(load(r + at), load(first_band + at), l2, y1, y2);
    store(z + at, y);
    y2 = y1;
    y1 = y;
    inverse2 = inverse1;
    inverse1 = load(inverse_pivot + at);
  }
  return solve_upwards(s, precisions, q, begin, inverse_pivot, first_band, r, z);
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
  const vreal q = load(stiffness + s.vector + column);
  const size_t begin = s.first_row * s.pitch + column, place = b * (s.pitch / VW) + column / VW;
  const size_t end = begin + s.rows * (size_t)s.pitch;
  for (size_t at = begin; at < end; at += s.pitch)
    store(r + at, load(weights + at) * load(data + at));
  bz[place] = lane_sum(solve_downwards(s, precisions, q, begin, inverse_pivot, first_band, r, z));
  for (size_t at = begin; at < end; at += s.pitch) store(r + at, load(r + at) - load(product + at));
  rz[place] = lane_sum(solve_downwards(s, precisions, q, begin, inverse_pivot, first_band, r, z));
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
    const vreal l2 = precision_at(precisions, s, i - 2) * q * inverse2;
    const vreal y = next_downwards(rest, load(first_band + at), l2, y1, y2);
    store(z + at, y);
    y2 = y1;
    y1 = y;
    inverse2 = inverse1;
    inverse1 = load(inverse_pivot + at);
  }
  rz_next[place] =
      lane_sum(solve_upwards(s, precisions, q, begin, inverse_pivot, first_band, r, z));
}
