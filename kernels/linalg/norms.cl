// Norms of the segments: partial results per block of rows, combined per segment in block order, so
// that a norm depends on nothing but its own segment.
//
//   squares  = |D|_F^2      largest = max |D_ij|
//
// Launch: one work-item per block (block_norms), one per active segment (segment_norms).

#define ENTRY vreal
#include "linalg/norms_entry.cl"

kernel void block_norms(global const segment_t* segments,  // [segments]
                        global const block_t* blocks,      // [blocks]
                        int block_count,
                        global const real* data,           // [rows x pitch] stacked
                        global double* partial_squares,    // [all blocks]
                        global double* partial_largest) {  // [all blocks]
  const int item = get_global_id(0);
  if (item >= block_count) return;
  const block_t block = blocks[item];
  const segment_t s = segments[block.segment];
  const entries_t entries = entries_of(block, s);
  norms_t norms = {0, 0};
  for (size_t i = entries.first; i < entries.last; i += VW) add_entry(&norms, load(data + i));
  partial_squares[s.first_block + block.block] = lane_sum(norms.squares);
  partial_largest[s.first_block + block.block] = lane_max(norms.largest);
}

kernel void segment_norms(global const segment_t* segments,  // [segments]
                          global const int* active,          // [active_count]
                          int active_count,
                          global const double* partial_squares,  // [all blocks]
                          global const double* partial_largest,  // [all blocks]
                          global double* frobenius,              // [segments]
                          global double* largest) {              // [segments]
  const int item = get_global_id(0);
  if (item >= active_count) return;
  const segment_t s = segments[active[item]];
  const int blocks = block_count_of(s);
  double squares = 0, most = 0;
  for (int b = 0; b < blocks; ++b) {
    squares += partial_squares[s.first_block + b];
    most = fmax(most, partial_largest[s.first_block + b]);
  }
  frobenius[active[item]] = sqrt(squares);
  largest[active[item]] = most;
}
