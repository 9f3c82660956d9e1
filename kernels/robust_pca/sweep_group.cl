// The element-wise steps of robust PCA where A = XW is a product of its own, in the notation of
// kernels/robust_pca/entry.cl, a work-group of WG work-items per block of rows: the form for GPUs.
// Beside products_group.cl it does what sweep.cl does in one go, an entry by the same steps. The
// residual is summed up in another order.
//
//   start      Y = dual_scale D, A = 0; where D is missing Y = 0, A = D as it was filled
//   form       order ae: X = D - E + Y/mu from T
//              order ea: E = soft(D - A + Y/mu, lambda/mu), X = A + clamp(D - A + Y/mu, ..)
//   shrink     order ae: T = mu (D - A) + Y        order ea: Y+ = mu (X - A)
//              |D - A - E|_F^2 = |(Y+ - Y)/mu|^2; where D is missing D = A, so that Y+ = 0
//   finish     order ae: E = (T - clamp(T, -lambda, lambda)) / mu     order ea: as `form` left it
//
// Neighbouring work-items take neighbouring entries, across the rows of a block, which are one run
// of memory. Launch: WG work-items per active block.

#include "robust_pca/state.cl"

#define ENTRY real
#define SCALAR real
#include "robust_pca/entry.cl"

#ifndef WG
#error "WG is not defined: work-items of a work-group, a power of two"
#endif

// What a work-group works on.
typedef struct {
  segment_t segment;
  global const state_t* state;
  entries_t entries;
  int block;  // among all blocks of the batch
} part_t;

INLINE part_t part_of(global const segment_t* segments, global const block_t* blocks,
                      global const state_t* states) {
  const block_t block = blocks[get_group_id(0)];
  const segment_t s = segments[block.segment];
  const part_t part = {s, states + block.segment, entries_of(block, s),
                       s.first_block + block.block};
  return part;
}

kernel __attribute__((reqd_work_group_size(WG, 1, 1))) void start(
    global const segment_t* segments,  // [segments]
    global const block_t* blocks,      // [active blocks]
    int block_count,                   // of active blocks
    global const state_t* states,      // [segments]
    global const real* data,           // D [rows x pitch] stacked
    int with_missing,
    global const real* observed,  // 0 where D is missing, and filled; else 1
    global real* t,               // Y
    global real* a) {             // A, order ea only
  if ((int)get_group_id(0) >= block_count) return;
  const part_t part = part_of(segments, blocks, states);
  const real dual_scale = part.state->dual_scale;
  for (size_t i = part.entries.first + get_local_id(0); i < part.entries.last; i += WG) {
    const real seen = with_missing ? observed[i] : 1;
    t[i] = first_dual(data[i], seen, dual_scale);
    if (part.state->order_ea) a[i] = first_low_rank(data[i], seen);
  }
}

kernel __attribute__((reqd_work_group_size(WG, 1, 1))) void form(
    global const segment_t* segments,  // [segments]
    global const block_t* blocks,      // [active blocks]
    int block_count,                   // of active blocks
    global const state_t* states,      // [segments]
    int wide_only,
    global const real* data,  // D [rows x pitch] stacked
    global const real* t,     // T, or Y
    global const real* a,     // A, order ea only
    global real* e,           // E, order ea only
    global real* x) {         // X
  if ((int)get_group_id(0) >= block_count) return;
  const part_t part = part_of(segments, blocks, states);
  if (part.state->finished || (wide_only && !is_wide(part.segment))) return;
  const scalars_t k = scalars_of(part.state);
  for (size_t i = part.entries.first + get_local_id(0); i < part.entries.last; i += WG)
    if (part.state->order_ea) {
      e[i] = sparse_part(data[i], t[i], a[i], k.inverse_mu, k.lambda);
      x[i] = shifted_ea(data[i], t[i], a[i], k.inverse_mu, k.lambda);
    } else {
      x[i] = shifted(data[i], t[i], k.inverse_last, k.inverse_mu, k.lambda);
    }
}

kernel __attribute__((reqd_work_group_size(WG, 1, 1))) void shrink(
    global const segment_t* segments,  // [segments]
    global const block_t* blocks,      // [active blocks]
    int block_count,                   // of active blocks
    global const state_t* states,      // [segments]
    global real* data,                 // D [rows x pitch] stacked
    int with_missing,                  // D becomes A where it is missing
    global const real* observed,       // 0 where D is missing, else 1
    global const real* x,              // X, order ea only
    global const real* a,              // A
    global real* t,                    // T -> T, or Y -> Y+
    global report_t* reports) {        // [all blocks]
  local real squares[WG], sparse[WG];
  const int lane = get_local_id(0);
  if ((int)get_group_id(0) >= block_count) return;  // uniform, as all that follow
  const part_t part = part_of(segments, blocks, states);
  if (part.state->finished) return;
  const scalars_t k = scalars_of(part.state);
  real sum = 0, any = 0;
  const int order_ea = part.state->order_ea;
  for (size_t base = part.entries.first; base < part.entries.last; base += WG) {
    const size_t i = base + lane;
    if (i >= part.entries.last) continue;
    const real known = a[i];
    real wanted = order_ea ? x[i] : data[i];
    if (with_missing) {
      wanted = observed_or(observed[i], wanted, known);
      data[i] = observed_or(observed[i], data[i], known);
    }
    const step_t step =
        order_ea ? step_ea(k, wanted, known, t[i]) : step_ae(k, wanted, known, t[i]);
    const real rest = step.rest * k.inverse_mu;
    sum += rest * rest;
    any += fabs(step.sparse);
    t[i] = step.kept;
  }
  squares[lane] = sum;
  sparse[lane] = any;
  barrier(CLK_LOCAL_MEM_FENCE);  // all terms are written
  sum = any = 0;
  for (int i = 0; i < WG; ++i) {  // in every work-item alike
    sum += squares[i];
    any += sparse[i];
  }
  const report_t report = {sum, any > 0};
  reports[part.block] = report;
}

kernel __attribute__((reqd_work_group_size(WG, 1, 1))) void finish(
    global const segment_t* segments,  // [segments]
    global const block_t* blocks,      // [active blocks]
    int block_count,                   // of active blocks
    global const state_t* states,      // [segments]
    global const real* e,              // E, order ea only
    global real* t) {                  // T, or Y -> E
  if ((int)get_group_id(0) >= block_count) return;
  const part_t part = part_of(segments, blocks, states);
  const real lambda = part.state->lambda, inverse_last = part.state->inverse_last;
  for (size_t i = part.entries.first + get_local_id(0); i < part.entries.last; i += WG)
    t[i] = part.state->order_ea ? e[i] : last_sparse_part(t[i], inverse_last, lambda);
}
