// Gram matrices of segments from those of their blocks of rows, and what lies between matrices X in
// single precision and square matrices in double precision.

#include "state.cl"
#include "tiles.cl"

#ifndef SWEEP_ROWS
#error "SWEEP_ROWS is not defined: rows that are widened to double at a time"
#endif

// G += the partial Gram matrices of the other blocks, in their order.
// Launch: (rows of the largest order, active segments).
kernel void sum_grams(global const segment_t* segments,  // [segments]
                      global const int* active,          // [active segments]
                      global const real* partial_grams,  // order x order matrices
                      global real* g) {                  // order x order matrices
  const segment_t s = segments[active[get_global_id(1)]];
  const int row = get_global_id(0);
  if (row >= s.order || is_wide(s)) return;
  const size_t square = (size_t)s.order * s.order_pitch, at = row * (size_t)s.order_pitch;
  for (int j = row / VW * VW; j < s.order_pitch; j += VW) {
    vreal sum = load(g + s.square + at + j);
    for (int b = 1; b < block_count_of(s); ++b)
      sum += load(partial_grams + s.partial + (b - 1) * square + at + j);
    store(g + s.square + at + j, sum);
  }
}

#if VW == 1
inline vreal widen(global const float* p) { return *p; }
#else
inline vreal widen(global const float* p) {
  return JOIN(convert_double, VW)(*(global const JOIN(float, VW)*)p);
}
#endif

// G = X'X of each block of rows, for X in single precision: the products are exact and summed in
// double. Launch: one work-item per block.
kernel void gram_of_floats(global const segment_t* segments,  // [segments]
                           global const block_t* blocks,      // [block_count]
                           int block_count,
                           global const float* x,         // [rows x pitch] stacked
                           global real* widened,          // [block_count x SWEEP_ROWS x pitch]
                           global real* g,                // order x order matrices: first blocks
                           global real* partial_grams) {  // order x order matrices: the others
  const int item = get_global_id(0);
  if (item >= block_count) return;
  const block_t block = blocks[item];
  const segment_t s = segments[block.segment];
  if (is_wide(s)) return;
  global real* rows = widened + item * (size_t)SWEEP_ROWS * s.pitch;
  global real* gram = block.block == 0 ? g + s.square
                                       : partial_grams + s.partial +
                                             (block.block - 1) * (size_t)s.order * s.order_pitch;
  const int begin = block_begin(block, s), end = block_end(block, s);
  for (int row = begin; row < end; row += SWEEP_ROWS) {
    const int count = min(SWEEP_ROWS, end - row);
    global const float* source = x + (s.first_row + row) * s.pitch;
    for (int i = 0; i < count * s.pitch; i += VW) store(rows + i, widen(source + i));
    add_gram(rows, gram, row == begin, s, count);
  }
}

// G = XX' of wide segments, for X in single precision.
// Launch: (rows of the largest order, active segments).
kernel void gram_of_wide_floats(global const segment_t* segments,  // [segments]
                                global const int* active,          // [active segments]
                                global const float* x,             // [rows x pitch] stacked
                                global real* g) {                  // order x order matrices
  const segment_t s = segments[active[get_global_id(1)]];
  const int i = get_global_id(0);
  if (i >= s.order || !is_wide(s)) return;
  global const float* xi = x + (s.first_row + i) * s.pitch;
  for (int j = i; j < s.order; ++j) {
    global const float* xj = x + (s.first_row + j) * s.pitch;
    real sum = 0;
    for (int k = 0; k < s.columns; ++k) sum = fma((real)xi[k], (real)xj[k], sum);
    g[s.square + i * (size_t)s.order_pitch + j] = sum;
  }
}

// The factors of A in single precision: V, f and Z at low rank, W else, or W in any case.
// Launch: (rows of the largest order, active segments).
kernel void narrow(global const segment_t* segments,  // [segments]
                   global const int* active,          // [active segments]
                   global const state_t* states,      // [segments]
                   int always_w,
                   global const real* w,  // order x order matrices
                   global const real* v,  // order x order matrices
                   global const real* z,  // order x order matrices
                   global const real* f,  // `order` per segment
                   global float* w_float, global float* v_float, global float* z_float,
                   global float* f_float) {
  const int index = active[get_global_id(1)];
  const segment_t s = segments[index];
  const int row = get_global_id(0);
  if (row >= s.order) return;
  const size_t at = s.square + row * (size_t)s.order_pitch;
  if (always_w || !states[index].low_rank) {
    for (int j = 0; j < s.order_pitch; ++j) w_float[at + j] = w[at + j];
    return;
  }
  f_float[s.vector + row] = f[s.vector + row];
  for (int j = 0; j < s.order_pitch; ++j) {
    // Columns of V past the rank are what the eigenproblem left there; f is zero for them.
    v_float[at + j] = j < states[index].rank ? v[at + j] : 0;
    if (row < states[index].rank) z_float[at + j] = z[at + j];
  }
}
