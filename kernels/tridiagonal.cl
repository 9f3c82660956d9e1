// Householder reduction of many symmetric matrices to tridiagonal form, A = Q T Q', one work-item a
// matrix (Golub and Van Loan, 8.3.1).
//
// A is scaled by a power of two to entries below 2, so neither tiny nor huge data over- or
// underflows. The reduction starts at the first row and T is handed on turned around, last row
// first: where A is graded, entry (i, j) of the size g_i g_j with decreasing g, the reduction has
// to start at the large end and QL at the small one for small eigenvalues to keep their relative
// accuracy.
//
// Notation: d, e diagonal and off-diagonal of T; H_k = I - u_k u_k', |u_k|^2 = 2; Q = H_0 H_1 ..;
// vectors are rows of `pitch` reals, zero from `n` on and outside the part a step works on.
// Launch: one work-item per active segment.

// Below this, a sum of squares has lost digits to underflow; entries of 1e-145 next to entries of 1
// are nothing.
#define NEGLIGIBLE_SQUARES ((real)1e-290)

// Vectors a work-item sums at the same time: enough to hide the latency of an addition.
#define WIDE 4

// Copies the upper triangle to the lower, clears the padding, and scales by the returned power of
// two's inverse.
inline real symmetrise(global real* a, int n, int pitch) {
  vreal most = 0;
  for (int i = 0; i < n; ++i) {
    global real* row = a + i * (size_t)pitch;
    const int whole = (i + VW - 1) / VW * VW;  // first whole vector right of the diagonal
    for (int j = n; j < pitch; ++j) row[j] = 0;
    for (int j = i; j < min(whole, n); ++j) most = fmax(most, (vreal)fabs(row[j]));
    for (int j = whole; j < pitch; j += VW) most = fmax(most, fabs(load(row + j)));
  }
  const real largest = lane_max(most);
  if (largest == 0) return 1;
  const int exponent = ilogb(largest);
  // Two factors: 2^-exponent alone overflows for subnormal entries.
  const real half_scale = ldexp((real)1, -(exponent / 2));
  const real scale = ldexp((real)1, -(exponent - exponent / 2));
  for (int i = 0; i < n; ++i)
    for (int j = i; j < n; ++j) {
      const real scaled = a[i * (size_t)pitch + j] * half_scale * scale;
      a[i * (size_t)pitch + j] = scaled;
      a[j * (size_t)pitch + i] = scaled;
    }
  return ldexp((real)1, exponent);
}

inline void zero(global real* v, int pitch) {
  for (int j = 0; j < pitch; j += VW) store(v + j, 0);
}

inline real dot_product(global const real* a, global const real* b, int pitch) {
  vreal sum = 0;
  for (int j = 0; j < pitch; j += VW) sum = fma(load(a + j), load(b + j), sum);
  return lane_sum(sum);
}

// u with H x = (.., e, 0, ..) for the entries x[k + 1 ..] of `row`; returns e. u = 0 (H = I) if the
// entries past x[k + 1] are zero anyway.
inline real reflector(global const real* row, global real* u, int k, int n, int pitch) {
  zero(u, pitch);
  for (int j = k + 2; j < n; ++j) u[j] = row[j];
  const real first = row[k + 1];
  const real rest = dot_product(u, u, pitch);
  if (rest < NEGLIGIBLE_SQUARES) {
    zero(u, pitch);
    return first;
  }
  const real norm = sqrt(fma(first, first, rest));
  const real e = first > 0 ? -norm : norm;
  u[k + 1] = first - e;
  const real scale = 1 / sqrt(fma(-first, e, norm * norm));  // |u|^2 = 2 (norm^2 - first e)
  for (int j = 0; j < pitch; j += VW) store(u + j, scale * load(u + j));
  return e;
}

// For the columns of `count` vectors from j on, rows i > k: a_i -= v_i w + w_i v (the previous
// step's update, delayed until the row is read anyway), and p = sum_i u_i a_i.
INLINE void update_columns(global real* a, global const real* v, global const real* w,
                           global const real* u, global real* p, int k, int n, int pitch, int j,
                           const int count) {
  vreal vj[WIDE], wj[WIDE], sum[WIDE];
#pragma unroll
  for (int c = 0; c < count; ++c) {
    vj[c] = load(v + j + c * VW);
    wj[c] = load(w + j + c * VW);
    sum[c] = 0;
  }
  for (int i = k + 1; i < n; ++i) {
    global real* entry = a + i * (size_t)pitch + j;
#pragma unroll
    for (int c = 0; c < count; ++c) {
      const vreal updated =
          fma((vreal)-w[i], vj[c], fma((vreal)-v[i], wj[c], load(entry + c * VW)));
      store(entry + c * VW, updated);
      sum[c] = fma((vreal)u[i], updated, sum[c]);
    }
  }
#pragma unroll
  for (int c = 0; c < count; ++c) store(p + j + c * VW, sum[c]);
}

inline void update_and_multiply(global real* a, global const real* v, global const real* w,
                                global const real* u, global real* p, int k, int n, int pitch) {
  int j = (k + 1) / VW * VW;
  for (; j + WIDE * VW <= pitch; j += WIDE * VW)
    update_columns(a, v, w, u, p, k, n, pitch, j, WIDE);
  for (; j + 2 * VW <= pitch; j += 2 * VW) update_columns(a, v, w, u, p, k, n, pitch, j, 2);
  for (; j < pitch; j += VW) update_columns(a, v, w, u, p, k, n, pitch, j, 1);
  for (int i = 0; i <= k; ++i) p[i] = 0;
}

// Step k: row k of T, and u, v, w of the update that the next steps still have to do.
inline real reduce_row(global real* a, global real* u, global real* v, global real* w,
                       global real* p, int k, int n, int pitch) {
  const real e = reflector(a + k * (size_t)pitch, u, k, n, pitch);
  update_and_multiply(a, v, w, u, p, k, n, pitch);
  const real half_product = (real)0.5 * dot_product(p, u, pitch);
  for (int j = 0; j < pitch; j += VW) {
    store(v + j, load(u + j));
    store(w + j, load(p + j) - half_product * load(u + j));
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

  scales[active[item]] = symmetrise(matrix, n, pitch);
  zero(v, pitch);
  zero(w, pitch);
  for (int k = 0; k < n; ++k) {
    global real* row = matrix + k * (size_t)pitch;
    for (int j = k / VW * VW; j < pitch; j += VW)
      store(row + j, load(row + j) - v[k] * load(w + j) - w[k] * load(v + j));
    d[s.vector + n - 1 - k] = row[k];
    if (k < n - 1)
      e[s.vector + n - 2 - k] =
          reduce_row(matrix, reflectors + s.square + k * (size_t)pitch, v, w, p, k, n, pitch);
  }
}
