// The element-wise steps of robust PCA for entries of type ENTRY, a vector or a number, with
// scalars of type SCALAR; in the notation of host/moclean/methods/robust_pca/reference.cpp.
//
// Order ae keeps one matrix between two iterations,
//   T = mu (D - A) + Y,   from which   Y+ = clamp(T, -lambda, lambda)   and   E = (T - Y+) / mu:
// where E is not zero Y+ is lambda or -lambda, so that one number tells both. Order ea keeps Y, in
// the place of T, and A.

typedef struct {
  SCALAR mu, inverse_last, inverse_mu, inverse_next;  // 1/mu of the iteration before, this, next
  SCALAR lambda;
} scalars_t;

INLINE scalars_t scalars_of(global const state_t* state) {
  const scalars_t k = {state->mu, state->inverse_last, 1 / state->mu, 1 / state->mu_next,
                       state->lambda};
  return k;
}

// min(max(t, -limit), limit). Comparisons compile to one instruction each; fmin and fmax, which
// look for NaN, to four.
INLINE ENTRY limited(ENTRY t, SCALAR limit) {
  const ENTRY raised = t < -limit ? (ENTRY)-limit : t;
  return raised > limit ? (ENTRY)limit : raised;
}

// Order ae: X = D - E + Y/mu, with the T and the 1/mu' of the iteration before.
INLINE ENTRY shifted(ENTRY d, ENTRY t, SCALAR inverse_last, SCALAR inverse_mu, SCALAR lambda) {
  const ENTRY dual = limited(t, lambda);
  return fma(dual, (ENTRY)inverse_mu, fma(dual - t, (ENTRY)inverse_last, d));
}

// Order ea: E = soft(D - A + Y/mu, lambda/mu) with the A of the iteration before.
INLINE ENTRY sparse_part(ENTRY d, ENTRY y, ENTRY a, SCALAR inverse_mu, SCALAR lambda) {
  const ENTRY gap = fma(y, (ENTRY)inverse_mu, d - a);
  return gap - limited(gap, lambda * inverse_mu);
}

// Order ea: X = D - E + Y/mu = A + clamp(D - A + Y/mu, -lambda/mu, lambda/mu).
INLINE ENTRY shifted_ea(ENTRY d, ENTRY y, ENTRY a, SCALAR inverse_mu, SCALAR lambda) {
  return a + limited(fma(y, (ENTRY)inverse_mu, d - a), lambda * inverse_mu);
}
