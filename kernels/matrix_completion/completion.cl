// One step of low-rank completion, in the notation of
// host/moclean/methods/matrix_completion/matrix_completion.hpp:
//
//   Y = Y + delta P(D - X),   squares = |P(D - X)|_F^2
//
// Launch: one work-item per block of rows of the active segments.

kernel void update_completion(global const segment_t* segments,  // [segments]
                              global const block_t* blocks,      // [blocks]
                              int block_count,
                              global const real* data,       // D, [rows x pitch], 0 where unseen
                              global const real* observed,   // [rows x pitch]: 1, 0 where unseen
                              global const real* deltas,     // [segments]
                              global const real* completed,  // X, [rows x pitch]
                              global real* dual,             // Y, [rows x pitch]
                              global double* partial_squares) {  // [all blocks]
  const int item = get_global_id(0);
  if (item >= block_count) return;
  const block_t block = blocks[item];
  const segment_t s = segments[block.segment];
  const int reals = (block_end(block, s) - block_begin(block, s)) * s.pitch;
  const long begin = (s.first_row + block_begin(block, s)) * s.pitch;
  const real delta = deltas[block.segment];

  vreal squares = 0;
  for (int i = 0; i < reals; i += VW) {
    const vreal r =
        load(observed + begin + i) * (load(data + begin + i) - load(completed + begin + i));
    store(dual + begin + i, fma((vreal)delta, r, load(dual + begin + i)));
    squares = fma(r, r, squares);
  }
  partial_squares[s.first_block + block.block] = lane_sum(squares);
}
