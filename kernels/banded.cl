// Symmetric positive definite band matrices along time: one system per column of a segment, its
// unknowns the rows. WIDTH is the half-bandwidth w and the order of the difference Delta over the
// rows of a segment (free ends: no rows beyond them).
//
//   assemble   A = diag(W) + q Delta'Delta
//   factor     A = L D L', in place: L(i, i - k) in band k, 1/D(i) in band 0
//   solve      L D L' x = b, b and x may be the same buffer
//   penalise   y = Delta'Delta x
//
// Band k holds the entries (i, i - k), zero for i < k. A factor per column has its bands as stacked
// matrices one after the other; a factor shared by the columns of a segment as WIDTH + 1 numbers
// per row. A pivot that is not positive counts as infinite, so that padding stays zero.
//
// Launch: (vectors of columns, active segments); `shared` factors: one work-item per active
// segment; penalise: one work-item per block of rows.

#ifndef WIDTH
#error "WIDTH is not defined: half-bandwidth, 1, 2 or 3"
#endif

#if WIDTH == 1
constant real difference[] = {-1, 1};
#elif WIDTH == 2
constant real difference[] = {1, -2, 1};
#else
constant real difference[] = {-1, 3, -3, 1};
#endif

// The entry (row, row - k) of Delta'Delta for so many rows: over the differences that touch both.
inline real penalty_entry(int row, int k, int rows) {
  real entry = 0;
  for (int j = max(k, row + WIDTH + 1 - rows); j <= min(WIDTH, row); ++j)
    entry += difference[j] * difference[j - k];
  return entry;
}

// The bands of one vector of columns, or those its segment shares. `shared` is a constant.
typedef struct {
  global real* first;
  size_t to_next_row, to_next_band;
} bands_t;

INLINE vreal band(const bands_t m, const int shared, int row, int k) {
  global const real* p = m.first + row * m.to_next_row + k * m.to_next_band;
  return shared ? (vreal)*p : load(p);
}

INLINE void set_band(const bands_t m, const int shared, int row, int k, vreal value) {
  global real* p = m.first + row * m.to_next_row + k * m.to_next_band;
  if (shared)
    *p = lane_max(value);  // all are the same
  else
    store(p, value);
}

INLINE bands_t bands_of(const segment_t s, const int shared, int column, long to_next_band,
                        global real* bands) {
  const bands_t own = {bands + s.first_row * s.pitch + column, s.pitch, to_next_band};
  const bands_t common = {bands + s.first_row * (WIDTH + 1), WIDTH + 1, 1};
  return shared ? common : own;
}

INLINE void assemble(const bands_t a, const int shared, const segment_t s,
                     global const real* weights, size_t to_next_weight, vreal q) {
  for (int i = 0; i < s.rows; ++i) {
    const vreal w = shared ? (vreal)*weights : load(weights + i * to_next_weight);
    set_band(a, shared, i, 0, fma(q, (vreal)penalty_entry(i, 0, s.rows), w));
    for (int k = 1; k <= WIDTH; ++k)
      set_band(a, shared, i, k, q * (i < k ? 0 : penalty_entry(i, k, s.rows)));
  }
}

INLINE vreal inverse_pivot(vreal pivot) { return pivot > 0 ? 1 / pivot : 0; }

// u_k = L(i, i - k) D(i - k), from the farthest entry on; l and m are the rows before, one and two.
INLINE void factor(const bands_t a, const int shared, int rows) {
  vreal l1 = 0, l2 = 0, m1 = 0, inverse1 = 0, inverse2 = 0, inverse3 = 0;
  for (int i = 0; i < rows; ++i) {
    vreal pivot = band(a, shared, i, 0), u1 = band(a, shared, i, 1), u2 = 0, u3 = 0;
    if (WIDTH > 1) u2 = band(a, shared, i, 2);
    if (WIDTH > 2) {
      u3 = band(a, shared, i, 3);
      u2 = fma(-u3, m1, u2);
      u1 = fma(-u3, l2, u1);
    }
    if (WIDTH > 1) u1 = fma(-u2, l1, u1);
    m1 = l1;
    if (WIDTH > 2) {
      const vreal l3 = u3 * inverse3;
      pivot = fma(-u3, l3, pivot);
      set_band(a, shared, i, 3, l3);
    }
    if (WIDTH > 1) {
      l2 = u2 * inverse2;
      pivot = fma(-u2, l2, pivot);
      set_band(a, shared, i, 2, l2);
    }
    l1 = u1 * inverse1;
    pivot = fma(-u1, l1, pivot);
    set_band(a, shared, i, 1, l1);
    inverse3 = inverse2;
    inverse2 = inverse1;
    inverse1 = inverse_pivot(pivot);
    set_band(a, shared, i, 0, inverse1);
  }
}

// L z = b down the rows, L' x = z / D up again; the three rows solved last stay in registers.
INLINE void solve(const bands_t l, const int shared, const segment_t s, global const real* b,
                  global real* x) {
  vreal x1 = 0, x2 = 0, x3 = 0;
  for (int i = 0; i < s.rows; ++i) {
    vreal z = load(b + i * (size_t)s.pitch);
    if (WIDTH > 2) z = fma(-band(l, shared, i, 3), x3, z);
    if (WIDTH > 1) z = fma(-band(l, shared, i, 2), x2, z);
    z = fma(-band(l, shared, i, 1), x1, z);
    x3 = x2;
    x2 = x1;
    x1 = z;
    store(x + i * (size_t)s.pitch, z);
  }
  vreal l1 = 0, l2 = 0, l3 = 0, next2 = 0, next3 = 0, nearest3 = 0;
  x1 = x2 = x3 = 0;
  for (int i = s.rows - 1; i >= 0; --i) {
    vreal z = load(x + i * (size_t)s.pitch) * band(l, shared, i, 0);
    if (WIDTH > 2) z = fma(-l3, x3, z);
    if (WIDTH > 1) z = fma(-l2, x2, z);
    z = fma(-l1, x1, z);
    x3 = x2;
    x2 = x1;
    x1 = z;
    store(x + i * (size_t)s.pitch, z);
    // Row i - 1 takes L(i, i - 1), L(i + 1, i - 1) and L(i + 2, i - 1).
    l1 = band(l, shared, i, 1);
    if (WIDTH > 1) {
      l2 = next2;
      next2 = band(l, shared, i, 2);
    }
    if (WIDTH > 2) {
      l3 = nearest3;
      nearest3 = next3;
      next3 = band(l, shared, i, 3);
    }
  }
}

kernel void assemble_columns(global const segment_t* segments,  // [segments]
                             global const int* active,          // [active segments]
                             long to_next_band,                 // reals of a stacked matrix
                             global const real* weights,        // W, [rows x pitch] stacked
                             global const real* penalties,      // q, [segments x pitch]
                             global real* bands) {              // [WIDTH + 1] stacked matrices
  const int b = active[get_global_id(1)], column = get_global_id(0) * VW;
  const segment_t s = segments[b];
  if (column >= s.pitch) return;
  assemble(bands_of(s, 0, column, to_next_band, bands), 0, s,
           weights + s.first_row * s.pitch + column, s.pitch,
           load(penalties + b * (size_t)s.pitch + column));
}

kernel void factor_columns(global const segment_t* segments,  // [segments]
                           global const int* active,          // [active segments]
                           long to_next_band,                 // reals of a stacked matrix
                           global real* bands) {              // [WIDTH + 1] stacked matrices
  const segment_t s = segments[active[get_global_id(1)]];
  const int column = get_global_id(0) * VW;
  if (column >= s.pitch) return;
  factor(bands_of(s, 0, column, to_next_band, bands), 0, s.rows);
}

kernel void solve_columns(global const segment_t* segments,  // [segments]
                          global const int* active,          // [active segments]
                          long to_next_band,                 // reals of a stacked matrix
                          global real* bands,                // the factor, as above
                          global const real* b,              // [rows x pitch] stacked
                          global real* x) {                  // [rows x pitch] stacked
  const segment_t s = segments[active[get_global_id(1)]];
  const int column = get_global_id(0) * VW;
  if (column >= s.pitch) return;
  const size_t first = s.first_row * s.pitch + column;
  solve(bands_of(s, 0, column, to_next_band, bands), 0, s, b + first, x + first);
}

kernel void factor_shared(global const segment_t* segments,  // [segments]
                          global const int* active,          // [active_count]
                          int active_count,
                          global const real* weights,    // c in A = c I + q Delta'Delta, [segments]
                          global const real* penalties,  // q, [segments]
                          global real* bands) {          // [rows x (WIDTH + 1)]
  const int item = get_global_id(0);
  if (item >= active_count) return;
  const int b = active[item];
  const bands_t a = bands_of(segments[b], 1, 0, 0, bands);
  assemble(a, 1, segments[b], weights + b, 0, penalties[b]);
  factor(a, 1, segments[b].rows);
}

kernel void solve_shared(global const segment_t* segments,  // [segments]
                         global const int* active,          // [active segments]
                         global real* bands,                // [rows x (WIDTH + 1)], the factor
                         global const real* b,              // [rows x pitch] stacked
                         global real* x) {                  // [rows x pitch] stacked
  const segment_t s = segments[active[get_global_id(1)]];
  const int column = get_global_id(0) * VW;
  if (column >= s.pitch) return;
  const size_t first = s.first_row * s.pitch + column;
  solve(bands_of(s, 1, 0, 0, bands), 1, s, b + first, x + first);
}

// One row of Delta'Delta x from the rows around it; those beyond the ends have weight 0.
INLINE void penalise_row(const segment_t s, int row, global const real* x, global real* y) {
  real weights[2 * WIDTH + 1];
  global const real* rows[2 * WIDTH + 1];
#pragma unroll
  for (int k = -WIDTH; k <= WIDTH; ++k) {
    const int inside = row + k >= 0 && row + k < s.rows;
    weights[k + WIDTH] = inside ? penalty_entry(row + max(k, 0), abs(k), s.rows) : 0;
    rows[k + WIDTH] = x + (inside ? row + k : row) * (size_t)s.pitch;
  }
  for (int column = 0; column < s.pitch; column += VW) {
    vreal sum = 0;
#pragma unroll
    for (int k = 0; k <= 2 * WIDTH; ++k) sum = fma((vreal)weights[k], load(rows[k] + column), sum);
    store(y + row * (size_t)s.pitch + column, sum);
  }
}

kernel void penalise(global const segment_t* segments,  // [segments]
                     global const block_t* blocks,      // [block_count]
                     int block_count,
                     global const real* x,  // [rows x pitch] stacked
                     global real* y) {      // [rows x pitch] stacked, another buffer
  const int item = get_global_id(0);
  if (item >= block_count) return;
  const block_t block = blocks[item];
  const segment_t s = segments[block.segment];
  const size_t first = s.first_row * s.pitch;
  for (int row = block_begin(block, s); row < block_end(block, s); ++row)
    penalise_row(s, row, x + first, y + first);
}
