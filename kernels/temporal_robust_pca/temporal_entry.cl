// The element-wise steps of robust PCA with a second-difference penalty for entries of type ENTRY,
// a vector or a number; what the kernels of temporal.cl and temporal_group.cl share. In the
// notation of host/moclean/methods/temporal_robust_pca/temporal_robust_pca.hpp:
//
//   X = S - U/mu, and after the next L
//   T = D - S + Y/mu, Y+ = clamp(mu T, -Lambda, Lambda), E = T - Y+/mu,
//   U+ = U + mu (L - S), and the right-hand side of the next S, which is
//   mu+ (D - E) + Y+ + mu+ L + U+ = mu+ (S + (Y+ - Y)/mu + L) + Y+ + U+
//
// Lambda is lambda where D was observed, else 0; there E, which is free, is left out of the result.

// X at `i`.
INLINE void shift_entry(global const real* smooth, global const real* dual, size_t i, real mu,
                        global real* x) {
  STORE(x + i, fma(LOAD(dual + i), (ENTRY)(-1 / mu), LOAD(smooth + i)));
}

typedef struct {
  real mu, inverse, next, lambda;  // mu, 1/mu, mu+, lambda
} weights_t;

INLINE weights_t weights_of(real mu, real mu_next, real lambda) {
  const weights_t k = {mu, 1 / mu, mu_next, lambda};
  return k;
}

// The stacked matrices.
typedef struct {
  global const real *data, *observed, *smooth, *low_rank;
  global real *sparse, *y, *u, *next;
} stacked_t;

// The entry at `i`; adds to |D - S - E|^2 and |L - S|^2.
INLINE void update_entry(const stacked_t m, size_t i, const weights_t k, ENTRY* gap, ENTRY* split) {
  const ENTRY d = LOAD(m.data + i), s = LOAD(m.smooth + i), l = LOAD(m.low_rank + i);
  const ENTRY y = LOAD(m.y + i), u = LOAD(m.u + i);
  const ENTRY seen = LOAD(m.observed + i), limit = k.lambda * seen;
  const ENTRY t = fma(y, (ENTRY)k.inverse, d - s);
  const ENTRY dual = clamp(k.mu * t, -limit, limit);
  const ENTRY rest = (dual - y) * k.inverse, apart = l - s;
  const ENTRY u_next = fma((ENTRY)k.mu, apart, u);
  STORE(m.sparse + i, seen * fma(-dual, (ENTRY)k.inverse, t));
  STORE(m.y + i, dual);
  STORE(m.u + i, u_next);
  STORE(m.next + i, fma((ENTRY)k.next, s + rest + l, dual + u_next));
  *gap = fma(rest, rest, *gap);
  *split = fma(apart, apart, *split);
}
