// The form for GPUs of block_norms (norms.cl), a work-group of WG work-items per block of rows.
// Neighbouring work-items take neighbouring entries, across the rows of a block, which are one run
// of memory. A block has SUMS sums whatever WG, so that the result does not depend on it.
// Launch: WG work-items per active block.

#ifndef WG
#error "WG is not defined: work-items of a work-group, at most SUMS"
#endif

#define SUMS 256

#define ENTRY real
#include "linalg/norms_entry.cl"

kernel __attribute__((reqd_work_group_size(WG, 1, 1))) void block_norms(
    global const segment_t* segments,  // [segments]
    global const block_t* blocks,      // [blocks]
    int block_count,
    global const real* data,           // [rows x pitch] stacked
    global double* partial_squares,    // [all blocks]
    global double* partial_largest) {  // [all blocks]
  local double squares[SUMS], largest[SUMS];
  if ((int)get_group_id(0) >= block_count) return;  // uniform
  const block_t block = blocks[get_group_id(0)];
  const segment_t s = segments[block.segment];
  const entries_t entries = entries_of(block, s);
  const int lane = get_local_id(0);
  for (int k = lane; k < SUMS; k += WG) {
    norms_t norms = {0, 0};
    for (size_t i = entries.first + k; i < entries.last; i += SUMS) add_entry(&norms, data[i]);
    squares[k] = norms.squares;
    largest[k] = norms.largest;
  }
  for (int width = SUMS / 2; width > 0; width /= 2) {
    barrier(CLK_LOCAL_MEM_FENCE);  // what there is so far is written
    for (int k = lane; k < width; k += WG) {
      squares[k] += squares[k + width];
      largest[k] = fmax(largest[k], largest[k + width]);
    }
  }
  if (lane == 0) {
    partial_squares[s.first_block + block.block] = squares[0];
    partial_largest[s.first_block + block.block] = largest[0];
  }
}
