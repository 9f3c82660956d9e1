// The element-wise steps of robust PCA for entries of type ENTRY, a vector or a number, with
// scalars of type SCALAR; in the notation of host/moclean/methods/robust_pca/reference.cpp. What
// sweep.cl, sweep_group.cl and partial_grams.cl share.
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

// Y of the first iteration; 0 where D is missing: `seen` is 0 there, else 1.
INLINE ENTRY first_dual(ENTRY d, ENTRY seen, SCALAR dual_scale) { return seen * d * dual_scale; }

// Order ea: A before the first iteration, 0, and D where that is missing.
INLINE ENTRY first_low_rank(ENTRY d, ENTRY seen) { return d - seen * d; }

// Order ea: X = D - E + Y/mu = A + clamp(D - A + Y/mu, -lambda/mu, lambda/mu).
INLINE ENTRY shifted_ea(ENTRY d, ENTRY y, ENTRY a, SCALAR inverse_mu, SCALAR lambda) {
  return a + limited(fma(y, (ENTRY)inverse_mu, d - a), lambda * inverse_mu);
}

// D or X, and A where D is missing: a weight of 0, so that Y stays 0; E = D - A is free there,
// which D = A says as well.
INLINE ENTRY observed_or(ENTRY seen, ENTRY value, ENTRY a) { return seen > 0 ? value : a; }

// What an iteration keeps of an entry, and what it reports.
typedef struct {
  ENTRY kept;    // T, or Y+
  ENTRY rest;    // Y+ - Y = mu (D - A - E)
  ENTRY sparse;  // mu E; order ea: 0
} step_t;

// Order ae, where A is known.
INLINE step_t step_ae(const scalars_t k, ENTRY d, ENTRY a, ENTRY t) {
  const ENTRY dual = limited(t, k.lambda);
  const ENTRY next = fma((ENTRY)k.mu, d - a, dual);
  const ENTRY dual_next = limited(next, k.lambda);
  const step_t step = {next, dual_next - dual, next - dual_next};
  return step;
}

// Order ea.
INLINE step_t step_ea(const scalars_t k, ENTRY x, ENTRY a, ENTRY y) {
  const ENTRY dual_next = k.mu * (x - a);
  const step_t step = {dual_next, dual_next - y, 0};
  return step;
}

// Order ae, at the end: E, with the 1/mu of the last iteration.
INLINE ENTRY last_sparse_part(ENTRY t, SCALAR inverse_last, SCALAR lambda) {
  return (t - limited(t, lambda)) * inverse_last;
}
