// The element-wise and scalar steps of robust PCA by inexact augmented Lagrange multipliers, in the
// notation of host/moclean/solve/reference/robust_pca.cpp:
//
//   start      Y = D / max(|D|_2, |D|_max / lambda)   mu = mu0_factor / |D|_2   first X (and E)
//   threshold  f_k = max(1 - (1/mu) / sigma_k, 0), rank = number of f_k > 0
//   shrink     order ae: E = soft(D - A + Y/mu, lambda/mu)    Y+ = Y + mu (D - A - E)
//                        X+ = D - E + Y+/mu+
//              order ea: Y+ = Y + mu (D - A - E)     E+ = soft(D - A + Y+/mu+, lambda/mu+)
//                        X+ = D - E+ + Y+/mu+        (E is kept: it belongs to A, E+ to the next A)
//   advance    residual = |D - A - E|_F, mu = mu+, iteration count, convergence
//
// Launch: one work-item per block of rows (start, shrink) or per active segment (threshold,
// advance).

typedef struct {
  real mu;       // of the running iteration
  real mu_next;  // of the one after it
  real mu_max;
  real lambda;
  real dual_scale;  // Y_0 = D * dual_scale
  real residual;    // |D - A - E|_F / |D|_F after the last iteration
  int iterations;
  int rank;
  int converged;
  int order_ea;  // 1: E is updated before A
} state_t;       // mirrors moclean::opencl::SegmentState

inline vreal soft(vreal t, real threshold) {
  return t - clamp(t, (vreal)(-threshold), (vreal)(threshold));
}

kernel void start_state(global const segment_t* segments,  // [segments]
                        global const int* active,          // [active_count]
                        int active_count,
                        global const real* eigenvalues,  // of D'D
                        global const real* largest,      // [segments]: max |D_ij|
                        real lambda,  // 0: lambda_scale / sqrt(max(rows, columns))
                        real lambda_scale, real mu0_factor, real mu_max_factor, real rho,
                        int order_ea,
                        global state_t* states) {  // [segments]
  const int item = get_global_id(0);
  if (item >= active_count) return;
  const segment_t s = segments[active[item]];
  real top = 0;
  for (int k = 0; k < s.order; ++k) top = fmax(top, eigenvalues[s.vector + k]);
  const real norm = sqrt(top);
  const real mu = mu0_factor / norm;
  const real weight = lambda > 0 ? lambda : lambda_scale / sqrt((real)max(s.rows, s.columns));
  global state_t* state = states + active[item];
  state->mu = mu;
  state->mu_next = fmin(rho * mu, mu * mu_max_factor);
  state->mu_max = mu * mu_max_factor;
  state->lambda = weight;
  state->dual_scale = 1 / fmax(norm, largest[active[item]] / weight);
  state->residual = 1;
  state->iterations = 0;
  state->rank = 0;
  state->converged = 0;
  state->order_ea = order_ea;
}

kernel void start(global const segment_t* segments,  // [segments]
                  global const block_t* blocks,      // [block_count]
                  int block_count,
                  global const state_t* states,  // [segments]
                  global const real* data,       // D [rows x pitch] stacked
                  global real* y,                // Y
                  global real* e,                // E
                  global real* x) {              // X
  const int item = get_global_id(0);
  if (item >= block_count) return;
  const segment_t s = segments[blocks[item].segment];
  global const state_t* state = states + blocks[item].segment;
  const size_t first = (s.first_row + block_begin(blocks[item])) * s.pitch;
  const size_t last = (s.first_row + block_end(blocks[item], s)) * s.pitch;
  const real inverse_mu = 1 / state->mu;
  for (size_t i = first; i < last; i += VW) {
    const vreal d = load(data + i);
    const vreal dual = d * state->dual_scale;
    const vreal t = fma(dual, (vreal)inverse_mu, d);
    const vreal sparse = state->order_ea ? soft(t, state->lambda * inverse_mu) : (vreal)0;
    store(y + i, dual);
    store(e + i, sparse);
    store(x + i, t - sparse);
  }
}

kernel void threshold(global const segment_t* segments,  // [segments]
                      global const int* active,          // [active_count]
                      int active_count,
                      global const real* eigenvalues,  // sigma^2, `order` per segment
                      global state_t* states,          // [segments]
                      global real* f) {                // `order` per segment
  const int item = get_global_id(0);
  if (item >= active_count) return;
  const segment_t s = segments[active[item]];
  const real tau = 1 / states[active[item]].mu;
  int rank = 0;
  for (int k = 0; k < s.order; ++k) {
    const real sigma = sqrt(fmax(eigenvalues[s.vector + k], (real)0));
    rank += sigma > tau;
    f[s.vector + k] = sigma > tau ? 1 - tau / sigma : 0;
  }
  states[active[item]].rank = rank;
}

kernel void shrink(global const segment_t* segments,  // [segments]
                   global const block_t* blocks,      // [block_count]
                   int block_count,
                   global const state_t* states,    // [segments]
                   global const real* data,         // D [rows x pitch] stacked
                   global const real* a,            // A
                   global real* y,                  // Y -> Y+
                   global real* e,                  // E, order ae: new; order ea: of this iteration
                   global real* x,                  // X -> X+
                   global real* partial_squares) {  // [all blocks]: |D - A - E|_F^2
  const int item = get_global_id(0);
  if (item >= block_count) return;
  const segment_t s = segments[blocks[item].segment];
  global const state_t* state = states + blocks[item].segment;
  const size_t first = (s.first_row + block_begin(blocks[item])) * s.pitch;
  const size_t last = (s.first_row + block_end(blocks[item], s)) * s.pitch;
  const real inverse_mu = 1 / state->mu, inverse_next = 1 / state->mu_next;
  vreal squares = 0;
  for (size_t i = first; i < last; i += VW) {
    const vreal gap = load(data + i) - load(a + i);
    const vreal dual = load(y + i);
    const vreal sparse = state->order_ea
                             ? fma(dual, (vreal)inverse_mu, load(data + i)) - load(x + i)
                             : soft(fma(dual, (vreal)inverse_mu, gap), state->lambda * inverse_mu);
    const vreal rest = gap - sparse;
    const vreal dual_next = fma((vreal)state->mu, rest, dual);
    const vreal sparse_next = state->order_ea ? soft(fma(dual_next, (vreal)inverse_next, gap),
                                                     state->lambda * inverse_next)
                                              : sparse;
    squares = fma(rest, rest, squares);
    store(y + i, dual_next);
    store(e + i, sparse);
    store(x + i, fma(dual_next, (vreal)inverse_next, load(data + i)) - sparse_next);
  }
  partial_squares[s.first_block + blocks[item].block] = lane_sum(squares);
}

kernel void advance(global const segment_t* segments,  // [segments]
                    global const int* active,          // [active_count]
                    int active_count,
                    global const real* partial_squares,  // [all blocks]
                    global const real* frobenius,        // [segments]: |D|_F
                    real rho, real tolerance,
                    global state_t* states) {  // [segments]
  const int item = get_global_id(0);
  if (item >= active_count) return;
  const segment_t s = segments[active[item]];
  global state_t* state = states + active[item];
  const int blocks = (s.rows + BLOCK_ROWS - 1) / BLOCK_ROWS;
  real squares = 0;
  for (int b = 0; b < blocks; ++b) squares += partial_squares[s.first_block + b];
  state->residual = sqrt(squares) / frobenius[active[item]];
  state->converged = state->residual <= tolerance;
  state->iterations += 1;
  state->mu = state->mu_next;
  state->mu_next = fmin(rho * state->mu, state->mu_max);
}
