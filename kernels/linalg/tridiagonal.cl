// Householder reduction of many symmetric matrices to tridiagonal form, A = Q T Q', one work-item a
// matrix (Golub and Van Loan, 8.3.1). One triangle is worked on, in whole vectors: row i of A from
// the block of VW x VW on the diagonal on, which is complete.
//
// A is scaled by a power of two to entries below 2, so neither tiny nor huge data over- or
// underflows. The reduction starts at the first row and T is handed on turned around, last row
// first: where A is graded, entry (i, j) of the size g_i g_j with decreasing g, the reduction has
// to start at the large end and QL at the small one for small eigenvalues to keep their relative
// accuracy.
//
// Notation: d, e diagonal and off-diagonal of T; H_k = I - u_k u_k', |u_k|^2 = 2; Q = H_0 H_1 ..;
// vectors are rows of `pitch` reals, zero from `n` on and outside the part a step works on.
// The steps are those of householder.cl, as in the form for GPUs (tridiagonal_group.cl).
// Launch: one work-item per active segment.

#define ENTRY vreal
#include "linalg/householder.cl"

// Rows that are updated side by side: enough to hide the latency of an addition, and no more than
// their factors and sums have registers.
#define ROWS (VW < 4 ? VW : 4)

inline int whole(int j) { return j / VW * VW; }  // first entry of the vector with entry j

// Clears the padding, scales the upper triangle by the returned power of two's inverse, and
// completes its blocks of VW x VW on the diagonal, so that whole vectors can be worked on.
inline real scale_triangle(global real* a, int n, int pitch) {
  vreal most = 0;
  for (int i = 0; i < n; ++i) {
    global real* row = a + i * (size_t)pitch;
    for (int j = n; j < pitch; ++j) row[j] = 0;
    for (int j = whole(i); j < i; ++j) row[j] = a[j * (size_t)pitch + i];
    for (int j = whole(i); j < pitch; j += VW) most = fmax(most, fabs(load(row + j)));
  }
  const scale_t scale = scale_of(lane_max(most));
  for (int i = 0; i < n; ++i)
    for (int j = whole(i); j < pitch; j += VW) {
      global real* entry = a + i * (size_t)pitch + j;
      store(entry, scaled(load(entry), scale));
    }
  return scale.power;
}

inline void zero(global real* v, int pitch) {
  for (int j = 0; j < pitch; j += VW) store(v + j, 0);
}

inline real dot_product(global const real* a, global const real* b, int pitch) {
  vreal sum = 0;
  for (int j = 0; j < pitch; j += VW) sum = fma(load(a + j), load(b + j), sum);
  return lane_sum(sum);
}

// u with H x = (.., e, 0, ..) for the entries x[k + 1 ..] of `row`; returns e.
inline real reflector(global const real* row, global real* u, int k, int pitch) {
  for (int j = 0; j < whole(k + 2); j += VW) store(u + j, 0);
  for (int j = whole(k + 2); j < pitch; j += VW) store(u + j, load(row + j));
  for (int j = whole(k + 2); j < min(k + 2, pitch); ++j) u[j] = 0;
  const real first = row[k + 1];
  const reflector_t h = reflector_of(first, dot_product(u, u, pitch));
  u[k + 1] = first - h.e;
  for (int j = 0; j < pitch; j += VW) store(u + j, h.scale * load(u + j));
  return h.e;
}

// Entries of a and b by turns: shuffles that are cheap.
#define ALTERNATE(v, a, b) \
  vreal v;                 \
  v.even = a;              \
  v.odd = b;

// The sums of the lanes of ROWS vectors, the sum of vector r in lane (begin + r) % VW of the
// result, the other lanes zero. `begin` is a multiple of ROWS.
INLINE vreal lane_sums(const vreal* v, int begin) {
  (void)begin;  // always 0 where VW = ROWS
#if VW == 1
  return v[0];
#else
  ALTERNATE(even, v[0].even, v[1].even);
  ALTERNATE(odd, v[0].odd, v[1].odd);
  const vreal two = even + odd;
#if VW == 2
  return two;
#else
  ALTERNATE(next_even, v[2].even, v[3].even);
  ALTERNATE(next_odd, v[2].odd, v[3].odd);
  const vreal next = next_even + next_odd;
#if VW == 4
  return (vreal)(two.lo, next.lo) + (vreal)(two.hi, next.hi);
#else
  const JOIN(REAL, 4) a = two.lo + two.hi, b = next.lo + next.hi, none = 0;
  const JOIN(REAL, 4) sums = (JOIN(REAL, 4))(a.lo, b.lo) + (JOIN(REAL, 4))(a.hi, b.hi);
  return begin % VW == 0 ? (vreal)(sums, none) : (vreal)(none, sums);
#endif
#endif
#endif
}

// For `count` <= ROWS rows from i on, from their block on the diagonal on: a_i -= v_i w + w_i v
// (the previous step's update, delayed until the row is read anyway), and p = A u. An entry a_ij
// right of the block stands for a_ji, too: p_j += a_ij u_i and p_i += a_ij u_j. Returns what they
// add to p for the columns of the block.
INLINE vreal update_rows(global real* a, global const real* v, global const real* w,
                         global const real* u, global real* p, int i, int pitch, const int count) {
  vreal vi[ROWS], wi[ROWS], ui[ROWS], sum[ROWS], block = 0;
  const int diagonal = whole(i);
  global real* row = a + i * (size_t)pitch;
#pragma unroll
  for (int r = 0; r < ROWS; ++r) sum[r] = 0;
#pragma unroll
  for (int r = 0; r < count; ++r) {
    vi[r] = v[i + r];
    wi[r] = w[i + r];
    ui[r] = u[i + r];
    global real* entry = row + r * pitch + diagonal;
    const vreal next = updated(load(entry), vi[r], wi[r], load(v + diagonal), load(w + diagonal));
    store(entry, next);
    block = fma(ui[r], next, block);
  }
  for (int j = diagonal + VW; j < pitch; j += VW) {
    const vreal vj = load(v + j), wj = load(w + j), uj = load(u + j);
    vreal column = load(p + j);
#pragma unroll
    for (int r = 0; r < count; ++r) {
      global real* entry = row + r * pitch + j;
      const vreal next = updated(load(entry), vi[r], wi[r], vj, wj);
      store(entry, next);
      sum[r] = fma(next, uj, sum[r]);
      column = fma(ui[r], next, column);
    }
    store(p + j, column);
  }
  return block + lane_sums(sum, i);
}

// A -= v w' + w v' and p = A u for the rows and columns past k.
inline void update_and_multiply(global real* a, global const real* v, global const real* w,
                                global const real* u, global real* p, int k, int n, int pitch) {
  zero(p, pitch);
  for (int i = (k + 1) / ROWS * ROWS; i < n;) {
    const int end = whole(i) + VW;  // of the rows that share a block on the diagonal
    vreal block = load(p + whole(i));
    for (; i + ROWS <= min(end, n); i += ROWS) block += update_rows(a, v, w, u, p, i, pitch, ROWS);
    // The last rows of all, which have nothing (if pitch > end, zeros) right of their block.
    for (; i < min(end, n); ++i) block += update_rows(a, v, w, u, p, i, pitch, 1);
    store(p + end - VW, block);
  }
  for (int i = 0; i <= k; ++i) p[i] = 0;
}

// Step k: row k of T, and u, v, w of the update that the next steps still have to do.
inline real reduce_row(global real* a, global real* u, global real* v, global real* w,
                       global real* p, int k, int n, int pitch) {
  const real e = reflector(a + k * (size_t)pitch, u, k, pitch);
  update_and_multiply(a, v, w, u, p, k, n, pitch);
  const real half_product = (real)0.5 * dot_product(p, u, pitch);
  for (int j = 0; j < pitch; j += VW) {
    store(v + j, load(u + j));
    store(w + j, update_vector(load(p + j), load(u + j), half_product));
  }
  return e;
}

kernel void tridiagonalise(global const segment_t* segments,  // [segments]
                           global const int* active,          // [active_count]
                           int active_count,
                           global const int* chosen,  // [segments]: 0 leaves a segment alone
                           global real* a,            // upper triangles; destroyed
                           global real* reflectors,   // u_k in row k
                           global real* d,            // `order` per segment, turned around
                           global real* e,            // `order` - 1 per segment, turned around
                           global real* scales,       // [segments]: A = scale Q T Q'
                           global real* scratch) {    // 3 vectors per segment
  const int item = get_global_id(0);
  if (item >= active_count) return;
  if (!chosen[active[item]]) return;
  const segment_t s = segments[active[item]];
  const int n = s.order, pitch = s.order_pitch;
  global real* matrix = a + s.square;
  global real* v = scratch + 3 * s.vector;
  global real* w = v + pitch;
  global real* p = w + pitch;

  scales[active[item]] = scale_triangle(matrix, n, pitch);
  zero(v, pitch);
  zero(w, pitch);
  for (int k = 0; k < n; ++k) {
    global real* row = matrix + k * (size_t)pitch;
    for (int j = whole(k); j < pitch; j += VW)
      store(row + j, updated(load(row + j), v[k], w[k], load(v + j), load(w + j)));
    d[s.vector + n - 1 - k] = row[k];
    if (k < n - 1)
      e[s.vector + n - 2 - k] =
          reduce_row(matrix, reflectors + s.square + k * (size_t)pitch, v, w, p, k, n, pitch);
  }
}
