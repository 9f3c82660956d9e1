// Symmetric eigenproblem A = Z' diag(values) Z of many matrices, one work-item a matrix:
// Householder reduction to tridiagonal form, then implicit QL (Golub and Van Loan, 8.3).
// Row k of Z is the eigenvector of values[k]; the values decrease.
//
// A is scaled by a power of two to entries below 2, so neither tiny nor huge data over- or
// underflows. A graded matrix, entry (i, j) of the size g_i g_j with decreasing g, keeps its small
// eigenvalues to relative accuracy: the reduction starts at the large end, QL at the small one (T
// is turned around in between), and an off-diagonal is negligible relative to its neighbours.
// Launch: one work-item per active segment.
//
// Notation: d, e diagonal and off-diagonal of the tridiagonal T = Q'AQ; H = I - u u', |u|^2 = 2;
// vectors are rows of `pitch` reals, zero from `n` on and outside the part a step works on.

#ifndef MAX_SWEEPS
#error "MAX_SWEEPS is not defined: QL sweeps allowed per eigenvalue"
#endif

#define EPSILON ((real)1.1102230246251565e-16)
// Below this, a sum of squares has lost digits to underflow; entries of 1e-145 next to entries of 1
// are nothing.
#define NEGLIGIBLE_SQUARES ((real)1e-290)

// Copies the upper triangle to the lower, clears the padding, and scales by the returned power of
// two's inverse.
inline real symmetrise(global real* a, int n, int pitch) {
  real largest = 0;
  for (int i = 0; i < n; ++i) {
    for (int j = i; j < n; ++j) largest = fmax(largest, fabs(a[i * (size_t)pitch + j]));
    for (int j = n; j < pitch; ++j) a[i * (size_t)pitch + j] = 0;
  }
  if (largest == 0) return 1;
  const int exponent = ilogb(largest);
  for (int i = 0; i < n; ++i)
    for (int j = i; j < n; ++j) {
      const real scaled = ldexp(a[i * (size_t)pitch + j], -exponent);
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

// One pass over the rows i > k of A: a_i -= v_i w + w_i v (the previous step's update, delayed
// until the row is read anyway), and p = sum_i u_i a_i.
inline void update_and_multiply(global real* a, global const real* v, global const real* w,
                                global const real* u, global real* p, int k, int n, int pitch) {
  for (int j = (k + 1) / VW * VW; j < pitch; j += VW) {
    const vreal vj = load(v + j), wj = load(w + j);
    vreal sum = 0;
    for (int i = k + 1; i < n; ++i) {
      global real* entry = a + i * (size_t)pitch + j;
      const vreal updated = load(entry) - v[i] * wj - w[i] * vj;
      store(entry, updated);
      sum = fma(u[i], updated, sum);
    }
    store(p + j, sum);
  }
}

// A -> T in d, e; the vectors u of the reflectors in the rows of `reflectors`.
inline void tridiagonalise(global real* a, global real* reflectors, global real* d, global real* e,
                           global real* v, global real* w, global real* p, int n, int pitch) {
  zero(v, pitch);
  zero(w, pitch);
  for (int k = 0; k < n; ++k) {
    global real* row = a + k * (size_t)pitch;
    for (int j = k / VW * VW; j < pitch; j += VW)
      store(row + j, load(row + j) - v[k] * load(w + j) - w[k] * load(v + j));
    d[k] = row[k];
    e[k] = 0;
    if (k == n - 1) return;

    global real* u = reflectors + k * (size_t)pitch;
    e[k] = reflector(row, u, k, n, pitch);
    update_and_multiply(a, v, w, u, p, k, n, pitch);
    for (int j = 0; j <= k; ++j) p[j] = 0;
    const real half_product = (real)0.5 * dot_product(p, u, pitch);
    for (int j = 0; j < pitch; j += VW) {
      store(v + j, load(u + j));
      store(w + j, load(p + j) - half_product * load(u + j));
    }
  }
}

// q = H_0 H_1 .. H_{n-2}, backwards, so that step k touches rows and columns > k only.
inline void accumulate(global const real* reflectors, global real* q, int n, int pitch) {
  for (int i = 0; i < n; ++i) {
    zero(q + i * (size_t)pitch, pitch);
    q[i * (size_t)pitch + i] = 1;
  }
  for (int k = n - 2; k >= 0; --k) {
    global const real* u = reflectors + k * (size_t)pitch;
    for (int j = (k + 1) / VW * VW; j < pitch; j += VW) {
      vreal product = 0;
      for (int i = k + 1; i < n; ++i) product = fma(u[i], load(q + i * (size_t)pitch + j), product);
      for (int i = k + 1; i < n; ++i) {
        global real* entry = q + i * (size_t)pitch + j;
        store(entry, fma(-u[i], product, load(entry)));
      }
    }
  }
}

// Turns T around and takes the columns of q, in that order, as the rows of z.
inline void turn_around(global const real* q, global real* z, global real* d, global real* e, int n,
                        int pitch) {
  for (int i = 0; i < n; ++i) {
    zero(z + i * (size_t)pitch, pitch);
    for (int j = 0; j < n; ++j) z[i * (size_t)pitch + j] = q[j * (size_t)pitch + n - 1 - i];
  }
  for (int i = 0, j = n - 1; i < j; ++i, --j) {
    const real swapped = d[i];
    d[i] = d[j];
    d[j] = swapped;
  }
  for (int i = 0, j = n - 2; i < j; ++i, --j) {
    const real swapped = e[i];
    e[i] = e[j];
    e[j] = swapped;
  }
}

// Rotates the rows m, m - 1 .. l of z by the rotations (c_i, s_i) of one QL sweep: rows i + 1 and i
// by rotation i. The row carried along stays in registers.
inline void rotate_rows(global real* z, global const real* c, global const real* s, int l, int m,
                        int pitch) {
  for (int j = 0; j < pitch; j += VW) {
    vreal carried = load(z + m * (size_t)pitch + j);
    for (int i = m - 1; i >= l; --i) {
      const vreal row = load(z + i * (size_t)pitch + j);
      store(z + (i + 1) * (size_t)pitch + j, s[i] * row + c[i] * carried);
      carried = c[i] * row - s[i] * carried;
    }
    store(z + l * (size_t)pitch + j, carried);
  }
}

// One implicit QL sweep on the unreduced block l .. m of T; the rotations go to c and s.
// Returns the first rotated index: l, or larger if the block fell apart on the way.
inline int ql_sweep(global real* d, global real* e, global real* c, global real* s, int l, int m) {
  const real shift = (d[l + 1] - d[l]) / (2 * e[l]);
  real g = d[m] - d[l] + e[l] / (shift + copysign(sqrt(fma(shift, shift, (real)1)), shift));
  real sine = 1, cosine = 1, p = 0;
  for (int i = m - 1; i >= l; --i) {
    const real f = sine * e[i], b = cosine * e[i];
    const real r = sqrt(fma(f, f, g * g));
    e[i + 1] = r;
    if (r == 0) {
      d[i + 1] -= p;
      e[m] = 0;
      return i + 1;
    }
    sine = f / r;
    cosine = g / r;
    g = d[i + 1] - p;
    const real t = fma(d[i] - g, sine, 2 * cosine * b);
    p = sine * t;
    d[i + 1] = g + p;
    g = fma(cosine, t, -b);
    c[i] = cosine;
    s[i] = sine;
  }
  d[l] -= p;
  e[l] = g;
  e[m] = 0;
  return l;
}

// Off-diagonal i does not matter: relative to its neighbours, or next to nothing at all.
inline int negligible(global const real* d, global const real* e, int i, real norm) {
  return fabs(e[i]) <= EPSILON * sqrt(fabs(d[i])) * sqrt(fabs(d[i + 1])) ||
         fabs(e[i]) <= EPSILON * EPSILON * norm;
}

// T = S diag(d) S', the rows of z taken along; returns 0 if it did not converge.
inline int diagonalise(global real* d, global real* e, global real* c, global real* s,
                       global real* z, int n, int pitch) {
  real norm = 0;
  for (int i = 0; i < n; ++i) norm = fmax(norm, fabs(d[i]) + fabs(e[i]));
  int sweeps = 0;
  for (int l = 0; l < n; ++l)
    for (;;) {
      int m = l;
      while (m < n - 1 && !negligible(d, e, m, norm)) ++m;
      if (m == l) break;
      if (++sweeps > MAX_SWEEPS * n) return 0;
      const int first = ql_sweep(d, e, c, s, l, m);
      rotate_rows(z, c, s, first, m, pitch);
    }
  return 1;
}

// The rows of `vectors` and their values d into z and `values`, by decreasing value; the sort is
// stable, so equal values keep their order.
inline void sort_into(global const real* vectors, global const real* d, global real* z,
                      global real* values, real scale, int n, int pitch) {
  for (int i = 0; i < n; ++i) {
    int rank = 0;
    for (int j = 0; j < n; ++j) rank += d[j] > d[i] || (d[j] == d[i] && j < i);
    values[rank] = scale * d[i];
    for (int j = 0; j < pitch; j += VW)
      store(z + rank * (size_t)pitch + j, load(vectors + i * (size_t)pitch + j));
  }
  for (int i = n; i < pitch; ++i) values[i] = 0;
}

kernel void symmetric_eigen(global const segment_t* segments,  // [segments]
                            global const int* active,          // [active_count]
                            int active_count,
                            global real* a,        // upper triangles; destroyed
                            global real* z,        // eigenvectors in rows
                            global real* values,   // eigenvalues
                            global real* work,     // scratch like a
                            global real* scratch,  // 5 vectors per segment
                            global int* failed) {  // [segments]: set to 1 where QL gave up
  const int item = get_global_id(0);
  if (item >= active_count) return;
  const segment_t segment = segments[active[item]];
  const int n = segment.order, pitch = segment.order_pitch;
  global real* matrix = a + segment.square;
  global real* reflectors = work + segment.square;
  global real* vectors = reflectors;  // once Q is formed
  global real* d = scratch + 5 * segment.vector;
  global real* e = d + pitch;
  global real* v = e + pitch;
  global real* w = v + pitch;
  global real* p = w + pitch;

  const real scale = symmetrise(matrix, n, pitch);
  tridiagonalise(matrix, reflectors, d, e, v, w, p, n, pitch);
  accumulate(reflectors, matrix, n, pitch);
  turn_around(matrix, vectors, d, e, n, pitch);
  if (!diagonalise(d, e, v, w, vectors, n, pitch)) failed[active[item]] = 1;
  sort_into(vectors, d, z + segment.square, values + segment.vector, scale, n, pitch);
}
