// Gram matrices of segments from those of their blocks of rows, and what lies between matrices X in
// single precision and square matrices in double precision.

#include "linalg/tiles.cl"
#include "robust_pca/state.cl"

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
typedef float vfloat;
inline vreal widen(vfloat v) { return v; }
inline vfloat narrowed(vreal v) { return (float)v; }
#else
typedef JOIN(float, VW) vfloat;
inline vreal widen(vfloat v) { return JOIN(convert_double, VW)(v); }
inline vfloat narrowed(vreal v) { return JOIN(convert_float, VW)(v); }
#endif

#define ENTRY vfloat
#define SCALAR float
#include "robust_pca/entry.cl"

INLINE vfloat load_floats(global const float* p) { return *(global const vfloat*)p; }
INLINE void store_floats(global float* p, vfloat v) { *(global vfloat*)p = v; }

INLINE void narrow_row(global const real* from, global float* to, int pitch) {
  for (int j = 0; j < pitch; j += VW) store_floats(to + j, narrowed(load(from + j)));
}

// G = X'X of each block of rows, for X in single precision: the products are exact and summed in
// double. X is D, or, `shifted_data`, the X of the running iteration, of segments that take an
// eigenproblem. Launch: one work-item per block.
kernel void gram_of_floats(global const segment_t* segments,  // [segments]
                           global const block_t* blocks,      // [block_count]
                           int block_count,
                           global const state_t* states,  // [segments]
                           global const int* decompose,   // [segments]
                           int shifted_data,
                           global const float* d,         // D [rows x pitch] stacked
                           global const float* t,         // T, or Y
                           global const float* a,         // A, order ea only
                           global real* widened,          // [block_count x SWEEP_ROWS x pitch]
                           global real* g,                // order x order matrices: first blocks
                           global real* partial_grams) {  // order x order matrices: the others
  const int item = get_global_id(0);
  if (item >= block_count) return;
  const block_t block = blocks[item];
  const segment_t s = segments[block.segment];
  global const state_t* state = states + block.segment;
  if (is_wide(s) || (shifted_data && !decompose[block.segment])) return;
  const scalars_t k = scalars_of(state);
  global real* rows = widened + item * (size_t)SWEEP_ROWS * s.pitch;
  global real* gram = gram_of(block, s, g, partial_grams);
  const int begin = block_begin(block, s), end = block_end(block, s);
  for (int row = begin; row < end; row += SWEEP_ROWS) {
    const int count = min(SWEEP_ROWS, end - row);
    const size_t first = (s.first_row + row) * s.pitch;
    for (int i = 0; i < count * s.pitch; i += VW) {
      vfloat x = load_floats(d + first + i);
      if (shifted_data) {
        const vfloat kept = load_floats(t + first + i);
        x = state->order_ea
                ? shifted_ea(x, kept, load_floats(a + first + i), k.inverse_mu, k.lambda)
                : shifted(x, kept, k.inverse_last, k.inverse_mu, k.lambda);
      }
      store(rows + i, widen(x));
    }
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

// The factors of A in single precision: V, f and Z at low rank, W else.
// Launch: (rows of the largest order, active segments).
kernel void narrow(global const segment_t* segments,  // [segments]
                   global const int* active,          // [active segments]
                   global const state_t* states,      // [segments]
                   global const real* w,              // order x order matrices
                   global const real* v,              // order x order matrices
                   global const real* z,              // order x order matrices
                   global const real* f,              // `order` per segment
                   global float* w_float, global float* v_float, global float* z_float,
                   global float* f_float) {
  const int index = active[get_global_id(1)];
  const segment_t s = segments[index];
  const int row = get_global_id(0);
  if (row >= s.order) return;
  const size_t at = s.square + row * (size_t)s.order_pitch;
  const int rank = states[index].rank;
  if (!states[index].low_rank) {
    narrow_row(w + at, w_float + at, s.order_pitch);
    return;
  }
  f_float[s.vector + row] = f[s.vector + row];
  if (row < rank) narrow_row(z + at, z_float + at, s.order_pitch);
  narrow_row(v + at, v_float + at, (rank + VW - 1) / VW * VW);
  // Columns of V past the rank are what the eigenproblem left there; f is zero for them.
  for (int j = rank; j < s.order_pitch; ++j) v_float[at + j] = 0;
}
