// The element-wise steps of robust PCA with a second-difference penalty, in the notation of
// host/moclean/solve/temporal_robust_pca.hpp:
//
//   shift    X = S - U/mu
//   update   T = D - S + Y/mu, Y+ = clamp(mu T, -Lambda, Lambda), E = T - Y+/mu,
//            U+ = U + mu (L - S), and the right-hand side of the next S, which is
//            mu+ (D - E) + Y+ + mu+ L + U+ = mu+ (S + (Y+ - Y)/mu + L) + Y+ + U+
//
// Lambda is lambda where D was observed, else 0; there E, which is free, is left out of the result.
// Launch: one work-item per block of rows of the active segments.

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
  const size_t first = (s.first_row + block_begin(blocks[item], s)) * s.pitch;
  const size_t last = (s.first_row + block_end(blocks[item], s)) * s.pitch;
  const vreal step = -1 / mus[blocks[item].segment];
  for (size_t i = first; i < last; i += VW)
    store(x + i, fma(load(dual + i), step, load(smooth + i)));
}

// The stacked matrices.
typedef struct {
  global const real *data, *observed, *smooth, *low_rank;
  global real *sparse, *y, *u, *next;
} rows_t;

// One vector; adds to |D - S - E|^2 and |L - S|^2.
INLINE void update_entries(const rows_t m, size_t i, real mu, real mu_next, real lambda, vreal* gap,
                           vreal* split) {
  const vreal s = load(m.smooth + i), l = load(m.low_rank + i), y = load(m.y + i);
  const vreal seen = load(m.observed + i), limit = lambda * seen, inverse = 1 / mu;
  const vreal t = fma(y, inverse, load(m.data + i) - s);
  const vreal dual = clamp(mu * t, -limit, limit);
  const vreal rest = (dual - y) * inverse, apart = l - s;
  const vreal u = fma((vreal)mu, apart, load(m.u + i));
  store(m.sparse + i, seen * fma(-dual, inverse, t));
  store(m.y + i, dual);
  store(m.u + i, u);
  store(m.next + i, fma((vreal)mu_next, s + rest + l, dual + u));
  *gap = fma(rest, rest, *gap);
  *split = fma(apart, apart, *split);
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
  const size_t first = (s.first_row + block_begin(block, s)) * s.pitch;
  const size_t last = (s.first_row + block_end(block, s)) * s.pitch;
  const rows_t m = {data, observed, smooth, low_rank, sparse, y, u, next};
  vreal gap = 0, split = 0;
  for (size_t i = first; i < last; i += VW)
    update_entries(m, i, mus[block.segment], next_mus[block.segment], lambdas[block.segment], &gap,
                   &split);
  partial_gaps[s.first_block + block.block] = lane_sum(gap);
  partial_splits[s.first_block + block.block] = lane_sum(split);
}
