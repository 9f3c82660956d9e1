// The form for GPUs of temporal.cl: shift and update, a work-group of WG work-items per block of
// rows. Neighbouring work-items take neighbouring entries, across the rows of a block, which are
// one run of memory. A block has SUMS sums of either kind whatever WG, so that the result does not
// depend on it. Launch: WG work-items per active block.

#ifndef WG
#error "WG is not defined: work-items of a work-group, at most SUMS"
#endif

#define SUMS 256

#define ENTRY real
#define LOAD(p) (*(p))
#define STORE(p, v) (*(p) = (v))
#include "temporal_robust_pca/temporal_entry.cl"

kernel __attribute__((reqd_work_group_size(WG, 1, 1))) void shift(
    global const segment_t* segments,  // [segments]
    global const block_t* blocks,      // [block_count]
    int block_count,
    global const real* mus,     // [segments]
    global const real* smooth,  // S, [rows x pitch]
    global const real* dual,    // U, [rows x pitch]
    global real* x) {           // X, [rows x pitch]
  if ((int)get_group_id(0) >= block_count) return;
  const block_t block = blocks[get_group_id(0)];
  const segment_t s = segments[block.segment];
  const entries_t entries = entries_of(block, s);
  const real mu = mus[block.segment];
  for (size_t i = entries.first + get_local_id(0); i < entries.last; i += WG)
    shift_entry(smooth, dual, i, mu, x);
}

kernel __attribute__((reqd_work_group_size(WG, 1, 1))) void update(
    global const segment_t* segments,  // [segments]
    global const block_t* blocks,      // [block_count]
    int block_count,
    global const real* mus,           // [segments]
    global const real* next_mus,      // mu+, [segments]
    global const real* lambdas,       // [segments]
    global const real* data,          // D, [rows x pitch], gaps filled
    global const real* observed,      // [rows x pitch]: 1, 0 where missing
    global const real* smooth,        // S, [rows x pitch]
    global const real* low_rank,      // L, [rows x pitch]
    global real* sparse,              // E, [rows x pitch]
    global real* y,                   // Y, [rows x pitch]
    global real* u,                   // U, [rows x pitch]
    global real* next,                // [rows x pitch]
    global double* partial_gaps,      // [all blocks]
    global double* partial_splits) {  // [all blocks]
  local double gaps[SUMS], splits[SUMS];
  if ((int)get_group_id(0) >= block_count) return;  // uniform
  const block_t block = blocks[get_group_id(0)];
  const segment_t s = segments[block.segment];
  const entries_t entries = entries_of(block, s);
  const stacked_t m = {data, observed, smooth, low_rank, sparse, y, u, next};
  const weights_t weights =
      weights_of(mus[block.segment], next_mus[block.segment], lambdas[block.segment]);
  const int lane = get_local_id(0);
  for (int k = lane; k < SUMS; k += WG) {
    real gap = 0, split = 0;
    for (size_t i = entries.first + k; i < entries.last; i += SUMS)
      update_entry(m, i, weights, &gap, &split);
    gaps[k] = gap;
    splits[k] = split;
  }
  for (int width = SUMS / 2; width > 0; width /= 2) {
    barrier(CLK_LOCAL_MEM_FENCE);  // the sums so far are written
    for (int k = lane; k < width; k += WG) {
      gaps[k] += gaps[k + width];
      splits[k] += splits[k + width];
    }
  }
  if (lane == 0) {
    partial_gaps[s.first_block + block.block] = gaps[0];
    partial_splits[s.first_block + block.block] = splits[0];
  }
}
