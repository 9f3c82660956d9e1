// The element-wise steps of robust PCA with a second-difference penalty, in the notation of
// host/moclean/methods/temporal_robust_pca/temporal_robust_pca.hpp:
//
//   shift    X = S - U/mu
//   update   E, Y+, U+ and the right-hand side of the next S
//
// An entry takes the steps of temporal_entry.cl, as in the form for GPUs (temporal_group.cl).
// Launch: one work-item per block of rows of the active segments.

#define ENTRY vreal
#define LOAD load
#define STORE store
#include "temporal_robust_pca/temporal_entry.cl"

kernel void shift(global const segment_t* segments,  // [segments]
                  global const block_t* blocks,      // [block_count]
                  int block_count,
                  global const real* mus,     // [segments]
                  global const real* smooth,  // S, [rows x pitch]
                  global const real* dual,    // U, [rows x pitch]
                  global real* x) {           // X, [rows x pitch]
  const int item = get_global_id(0);
  if (item >= block_count) return;
  const segment_t s = segments[blocks[item].segment];
  const entries_t entries = entries_of(blocks[item], s);
  const real mu = mus[blocks[item].segment];
  for (size_t i = entries.first; i < entries.last; i += VW) shift_entry(smooth, dual, i, mu, x);
}

kernel void update(global const segment_t* segments,  // [segments]
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
  const int item = get_global_id(0);
  if (item >= block_count) return;
  const block_t block = blocks[item];
  const segment_t s = segments[block.segment];
  const entries_t entries = entries_of(block, s);
  const stacked_t m = {data, observed, smooth, low_rank, sparse, y, u, next};
  const weights_t k =
      weights_of(mus[block.segment], next_mus[block.segment], lambdas[block.segment]);
  vreal gap = 0, split = 0;
  for (size_t i = entries.first; i < entries.last; i += VW) update_entry(m, i, k, &gap, &split);
  partial_gaps[s.first_block + block.block] = lane_sum(gap);
  partial_splits[s.first_block + block.block] = lane_sum(split);
}
