// The scalar steps of robust PCA by inexact augmented Lagrange multipliers, in the notation of
// host/moclean/methods/robust_pca/reference.cpp:
//
//   start      mu = mu0_factor / |D|_2, Y = D / max(|D|_2, |D|_max / lambda)
//   threshold  f_k = max(1 - (1/mu) / sigma_k, 0), rank = number of f_k > 0
//   advance    residual = |D - A - E|_F, mu = mu+, iteration count, convergence
//
// As long as no entry of T reaches lambda/mu, E is zero and D, Y and X share their singular
// vectors. Such a segment is called pure and takes no eigenproblem: with delta, xi, y the singular
// values of D, X, Y,   xi = delta + y/mu   and   y+ = mu (xi - max(xi - 1/mu, 0)) = min(mu xi, 1).
//
// Launch: one work-item per active segment.

#include "robust_pca/state.cl"

kernel void start_state(global const segment_t* segments,  // [segments]
                        global const int* active,          // [active_count]
                        int active_count,
                        global const real* eigenvalues,  // of D'D
                        global const real* largest,      // [segments]: max |D_ij|
                        real lambda,  // 0: lambda_scale / sqrt(max(rows, columns))
                        real lambda_scale, real mu0_factor, real mu_max_factor, real rho,
                        int order_ea, int pure, int max_iterations,
                        real keep_below,          // A is kept from this residual on
                        global state_t* states,   // [segments]
                        global real* dual,        // y, `order` per segment
                        global int* decompose) {  // [segments]: 1 asks for the eigenproblem of X
  const int item = get_global_id(0);
  if (item >= active_count) return;
  const segment_t s = segments[active[item]];
  const real norm = sqrt(fmax(eigenvalues[s.vector], (real)0));  // they decrease
  const real mu = mu0_factor / norm;
  const real weight = lambda > 0 ? lambda : lambda_scale / sqrt((real)max(s.rows, s.columns));
  global state_t* state = states + active[item];
  state->mu = mu;
  state->mu_next = fmin(rho * mu, mu * mu_max_factor);
  state->inverse_last = 0;
  state->mu_max = mu * mu_max_factor;
  state->lambda = weight;
  state->dual_scale = 1 / fmax(norm, largest[active[item]] / weight);
  state->residual = 1;
  state->iterations = 0;
  state->rank = 0;
  state->converged = 0;
  state->finished = 0;
  state->order_ea = order_ea;
  state->pure = pure;
  state->keep = state->residual <= keep_below || max_iterations == 1;
  state->low_rank = 0;
  decompose[active[item]] = !pure;
  for (int k = 0; k < s.order; ++k)
    dual[s.vector + k] = state->dual_scale * sqrt(fmax(eigenvalues[s.vector + k], (real)0));
}

kernel void threshold(global const segment_t* segments,  // [segments]
                      global const int* active,          // [active_count]
                      int active_count,
                      global const real* eigenvalues,  // of X'X, of D'D while pure
                      int low_rank_permitted,          // whether V is there
                      global state_t* states,          // [segments]
                      global real* dual,               // y while pure, `order` per segment
                      global real* f,                  // `order` per segment
                      global int* wanted,              // [segments]: eigenvectors needed
                      global int* terms) {  // [segments]: of W; 0 where A = (XV) diag(f) V'
  const int item = get_global_id(0);
  if (item >= active_count) return;
  const segment_t s = segments[active[item]];
  global state_t* state = states + active[item];
  if (state->finished) return;
  const real tau = 1 / state->mu;
  int rank = 0;
  for (int k = 0; k < s.order; ++k) {
    real sigma = sqrt(fmax(eigenvalues[s.vector + k], (real)0));
    if (state->pure) {
      sigma = fma(dual[s.vector + k], tau, sigma);
      dual[s.vector + k] = fmin(state->mu * sigma, (real)1);
    }
    rank += sigma > tau;
    f[s.vector + k] = sigma > tau ? 1 - tau / sigma : 0;
  }
  state->rank = rank;
  wanted[active[item]] = rank;
  state->low_rank = low_rank_permitted && !is_wide(s) && 7 * rank < 3 * s.order;
  terms[active[item]] = state->low_rank ? 0 : max(rank, 1);
}

kernel void advance(global const segment_t* segments,  // [segments]
                    global const int* active,          // [active_count]
                    int active_count,
                    global const report_t* reports,  // [all blocks]
                    global const real* frobenius,    // [segments]: |D|_F
                    real rho, real tolerance, int max_iterations,
                    real keep_below,         // A is kept from this residual on
                    int keep_pure,           // 0: no segment counts as pure from now on
                    global state_t* states,  // [segments]
                    global int* decompose,   // [segments]
                    global int* wanted) {    // [segments]
  const int item = get_global_id(0);
  if (item >= active_count) return;
  const segment_t s = segments[active[item]];
  global state_t* state = states + active[item];
  if (state->finished) return;
  real squares = 0;
  int sparse = 0;
  for (int b = 0; b < block_count_of(s); ++b) {
    squares += reports[s.first_block + b].squares;
    sparse |= reports[s.first_block + b].sparse;
  }
  state->residual = sqrt(squares) / frobenius[active[item]];
  state->converged = state->residual <= tolerance;
  state->iterations += 1;
  state->inverse_last = 1 / state->mu;
  state->mu = state->mu_next;
  state->mu_next = fmin(rho * state->mu, state->mu_max);
  state->pure = state->pure && !sparse && keep_pure;
  state->finished = state->converged || state->iterations >= max_iterations;
  decompose[active[item]] = !state->finished && !state->pure;
  if (state->finished)
    wanted[active[item]] = 0;
  else
    state->keep = state->residual <= keep_below || state->iterations + 1 >= max_iterations;
}
