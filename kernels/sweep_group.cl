// The element-wise steps of robust PCA where A = XW is known, in the notation of
// host/moclean/solve/reference/robust_pca.cpp, a work-group of WG work-items per block of rows: the
// form for GPUs. Beside products_group.cl it does what sweep.cl does in one go.
//
//   order ae: T = D - A + Y/mu                Y+ = clamp(mu T, -lambda, lambda)
//             X+ = A - Y/mu + Y+ (1/mu + 1/mu+)
//   order ea: Y+ = mu (X - A)                 T+ = D - A + Y+/mu+
//             E+ = soft(T+, lambda/mu+)       X+ = A + clamp(T+, -lambda/mu+, lambda/mu+)
//   |D - A - E|_F^2 = |(Y+ - Y)/mu|^2
//
// Neighbouring work-items take neighbouring entries, across the rows of a block, which are one run
// of memory. Launch: WG work-items per active block.

#include "state.cl"

#ifndef WG
#error "WG is not defined: work-items of a work-group, a power of two"
#endif

// Y, the first X, and for order ea the first E.
kernel __attribute__((reqd_work_group_size(WG, 1, 1))) void start(
    global const segment_t* segments,  // [segments]
    global const block_t* blocks,      // [active blocks]
    int block_count,                   // of active blocks
    global const state_t* states,      // [segments]
    global const real* data,           // D [rows x pitch] stacked
    global real* y,                    // Y
    global real* x,                    // X
    global real* e) {                  // E, order ea only
  if ((int)get_group_id(0) >= block_count) return;
  const block_t block = blocks[get_group_id(0)];
  const segment_t s = segments[block.segment];
  global const state_t* state = states + block.segment;
  const real inverse_mu = 1 / state->mu, dual_scale = state->dual_scale;
  const real limit = state->lambda * inverse_mu;
  const size_t last = (s.first_row + block_end(block, s)) * s.pitch;
  for (size_t i = (s.first_row + block_begin(block, s)) * s.pitch + get_local_id(0); i < last;
       i += WG) {
    const real dual = data[i] * dual_scale;
    const real t = fma(dual, inverse_mu, data[i]);
    const real kept = state->order_ea ? clamp(t, -limit, limit) : t;  // E = soft(T), X = T - E
    y[i] = dual;
    x[i] = kept;
    if (state->order_ea) e[i] = t - kept;
  }
}

// One entry of order ae; returns the squared residual. x_next holds A.
INLINE real update_ae(global const state_t* s, real d, global real* y, global real* x_next,
                      real* largest) {
  const real mu = s->mu, lambda = s->lambda, inverse = 1 / mu, inverse_next = 1 / s->mu_next;
  const real dual = *y, a = *x_next;
  const real t = fma(mu, d - a, dual);
  const real dual_next = clamp(t, -lambda, lambda);
  const real rest = (dual_next - dual) * inverse;
  *largest = fmax(*largest, fabs(t));
  *y = dual_next;
  *x_next = fma(dual_next, inverse + inverse_next, fma(dual, -inverse, a));
  return rest * rest;
}

// The same for order ea, and E+, which belongs to the next A.
INLINE real update_ea(global const state_t* s, real d, real x, global real* y, global real* x_next,
                      global real* e_next) {
  const real mu = s->mu, inverse_next = 1 / s->mu_next, limit = s->lambda * inverse_next;
  const real dual = *y, a = *x_next;
  const real dual_next = mu * (x - a);
  const real rest = (dual_next - dual) / mu;
  const real t_next = fma(dual_next, inverse_next, d - a);
  const real kept = clamp(t_next, -limit, limit);
  *y = dual_next;
  *x_next = a + kept;
  *e_next = t_next - kept;
  return rest * rest;
}

kernel __attribute__((reqd_work_group_size(WG, 1, 1))) void shrink(
    global const segment_t* segments,  // [segments]
    global const block_t* blocks,      // [active blocks]
    int block_count,                   // of active blocks
    global const state_t* states,      // [segments]
    global const real* data,           // D [rows x pitch] stacked
    global const real* x,              // X, order ea only
    global real* y,                    // Y -> Y+
    global real* a,                    // A -> X+
    global real* e_next,               // E+, order ea only
    global double* partial_squares,    // [all blocks]: |D - A - E|_F^2
    global int* partial_sparse) {      // [all blocks]: whether E is not zero; order ae only
  local real squares[WG], largest[WG];
  const int lane = get_local_id(0);
  if ((int)get_group_id(0) >= block_count) return;  // uniform, as all that follow
  const block_t block = blocks[get_group_id(0)];
  const segment_t s = segments[block.segment];
  global const state_t* state = states + block.segment;
  if (state->finished) return;
  const size_t first = (s.first_row + block_begin(block, s)) * s.pitch;
  const size_t last = (s.first_row + block_end(block, s)) * s.pitch;
  real sum = 0, top = 0;
  for (size_t base = first; base < last; base += WG) {
    const size_t i = base + lane;
    if (i >= last) continue;
    sum += state->order_ea ? update_ea(state, data[i], x[i], y + i, a + i, e_next + i)
                           : update_ae(state, data[i], y + i, a + i, &top);
  }
  squares[lane] = sum;
  largest[lane] = top;
  barrier(CLK_LOCAL_MEM_FENCE);  // all terms are written
  sum = top = 0;
  for (int i = 0; i < WG; ++i) {  // in every work-item alike
    sum += squares[i];
    top = fmax(top, largest[i]);
  }
  partial_squares[s.first_block + block.block] = sum;
  partial_sparse[s.first_block + block.block] = top > state->lambda;
}

// E of segments that have finished, from the X that their last iteration read and the X+ and Y+
// that it wrote (mu is mu+ by now); leaves that X in both places, for A = XW.
//   order ae: E = D + Y+/mu+ - X+, and zero where |Y+| < lambda; order ea: as it was kept.
kernel __attribute__((reqd_work_group_size(WG, 1, 1))) void finish(
    global const segment_t* segments,  // [segments]
    global const block_t* blocks,      // [active blocks]
    int block_count,                   // of active blocks
    global const state_t* states,      // [segments]
    global real* x_even,               // X of iterations 0, 2, .. -> X of the last
    global real* x_odd,                // X of iterations 1, 3, .. -> the same
    global const real* e_even,         // E likewise, order ea only
    global const real* e_odd,
    global const real* data,  // D
    global real* y) {         // Y+ -> E
  if ((int)get_group_id(0) >= block_count) return;
  const block_t block = blocks[get_group_id(0)];
  const segment_t s = segments[block.segment];
  global const state_t* state = states + block.segment;
  const int last_odd = (state->iterations + 1) % 2;
  global real* x = last_odd ? x_odd : x_even;
  global real* x_next = last_odd ? x_even : x_odd;
  global const real* e = last_odd ? e_odd : e_even;
  const size_t last = (s.first_row + block_end(block, s)) * s.pitch;
  for (size_t i = (s.first_row + block_begin(block, s)) * s.pitch + get_local_id(0); i < last;
       i += WG) {
    const real sparse = fma(y[i], (real)(1 / state->mu), data[i]) - x_next[i];
    y[i] = state->order_ea ? e[i] : fabs(y[i]) < state->lambda ? 0 : sparse;
    x_next[i] = x[i];
  }
}
