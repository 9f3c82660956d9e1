// Eigenvectors and eigenvalues of many symmetric matrices A = Z' diag(values) Z from what
// tridiagonal_group.cl leaves, A = Q T Q': implicit QL (Golub and Van Loan, 8.3.3), a work-group of
// WG work-items per matrix. Row k of Z is the eigenvector of values[k]; the values decrease.
//
//   group_accumulate   V = Q', its rows in reverse
//   group_diagonalise  T = S' diag(values) S,  V = S V
//   group_sort         Z = the rows of V by decreasing value
//
// A graded matrix keeps its small eigenvalues to relative accuracy: the reduction starts at its
// large end, QL at the small one, hence the reverse. Columns of V are dealt to the work-items, so
// that neighbours touch neighbouring reals of a row. Launch: WG work-items per active segment.
//
// Notation: d, e diagonal and off-diagonal of T; c, s cosines and sines of one QL sweep.

#ifndef WG
#error "WG is not defined: work-items of a work-group, a power of two"
#endif
#ifndef MAX_SWEEPS
#error "MAX_SWEEPS is not defined: QL sweeps allowed per eigenvalue"
#endif

// Contraction is left to no compiler: fma stands where it is meant.
#pragma OPENCL FP_CONTRACT OFF

#define EPSILON ((real)1.1102230246251565e-16)

// V = H_{n-2} .. H_1 H_0, row i of the product in row n - 1 - i, each work-item by whole columns.
kernel __attribute__((reqd_work_group_size(WG, 1, 1))) void group_accumulate(
    global const segment_t* segments,  // [segments]
    global const int* active,          // [active segments]
    global const int* chosen,          // [segments]: 0 leaves a segment as it is
    global const real* reflectors,     // u of reflector k in row k, past k
    global real* vectors) {            // V, order x order matrices
  const int b = active[get_group_id(0)];
  if (!chosen[b]) return;  // uniform
  const segment_t s = segments[b];
  const int n = s.order;
  const long pitch = s.order_pitch;
  for (int j = get_local_id(0); j < n; j += WG) {
    global real* column = vectors + s.square + (n - 1) * pitch + j;  // upwards: the product's rows
    for (int i = 0; i < n; ++i) column[-i * pitch] = i == j;
    // One pass per reflector over the column: what it leaves is multiplied by the next at once.
    global const real* u = reflectors + s.square;
    real product = 0;
    for (int i = 1; i < n; ++i) product = fma(u[i], column[-i * pitch], product);
    for (int k = 0; k < n - 1; ++k, u += pitch) {
      column[-(k + 1) * pitch] = fma(-u[k + 1], product, column[-(k + 1) * pitch]);
      real next = 0;
      for (int i = k + 2; i < n; ++i) {
        const real left = fma(-u[i], product, column[-i * pitch]);
        column[-i * pitch] = left;
        next = fma(u[pitch + i], left, next);
      }
      product = next;
    }
  }
}

// Off-diagonal i does not matter: relative to its neighbours, or next to nothing at all. (A is
// scaled to |A|_2 >= 1; where a product underflows the second criterion decides.)
INLINE int is_negligible(real e, real d, real d_next) {
  return e * e <= EPSILON * EPSILON * fabs(d) * fabs(d_next) || fabs(e) <= EPSILON * EPSILON;
}

typedef struct {
  local real *d, *e;
} tridiagonal_t;

INLINE int negligible(const tridiagonal_t t, int i) {
  return is_negligible(t.e[i], t.d[i], t.d[i + 1]);
}

#define ENTRY real
#include "linalg/ql.cl"

// What the first work-item knows of T: the eigenvalues before `first` are done, first .. last is an
// unreduced block, except that its first off-diagonal may be negligible.
typedef struct {
  int first, last, sweeps;
} progress_t;

// One implicit QL sweep on the block l .. m of T; the rotations go to c and s. Returns the first
// rotated index: l, or larger if the block fell apart on the way. Shortens progress->last to the
// first negligible off-diagonal past l.
INLINE int ql_sweep(local real* d, local real* e, local real* c, local real* s, int l, int m,
                    local progress_t* progress) {
  real g = shifted_end(d[l], d[l + 1], e[l], d[m]);
  real sine = 1, cosine = 1, p = 0, d_next = 0;
  int i = m - 1;
  for (; i >= l; --i) {
    const real f = sine * e[i], b = cosine * e[i], squares = fma(f, f, g * g);
    if (squares == 0) break;
    const real inverse = rsqrt(squares), e_new = squares * inverse;
    sine = f * inverse;
    cosine = g * inverse;
    g = d[i + 1] - p;
    const real t = fma(d[i] - g, sine, 2 * cosine * b);
    p = sine * t;
    const real d_new = g + p;
    g = fma(cosine, t, -b);
    if (i < m - 1 && is_negligible(e_new, d_new, d_next)) progress->last = i + 1;
    e[i + 1] = e_new;
    d[i + 1] = d_next = d_new;
    c[i] = cosine;
    s[i] = sine;
  }
  if (i >= l) progress->last = i + 1;
  d[i + 1] -= p;
  e[i + 1] = i >= l ? 0 : g;
  e[m] = 0;
  return i + 1;
}

// The next sweep's rotations, l .. m - 1, as (l, m); (0, -1) if there is nothing left, or if the
// sweeps are used up.
INLINE int2 next_sweep(local real* d, local real* e, local real* rotations,
                       local progress_t* progress, int n, int pitch) {
  const tridiagonal_t t = {d, e};
  const int2 block = next_block(t, progress->first, progress->last, n);
  const int l = block.x, m = block.y;
  progress->first = l;
  progress->last = m;
  progress->sweeps += 1;
  if (l == n || progress->sweeps > MAX_SWEEPS * n) return (int2)(0, -1);
  return (int2)(ql_sweep(d, e, rotations, rotations + pitch, l, m, progress), m);
}

// Rotates the rows m, m - 1 .. l of V: rows i + 1 and i by rotation i. The row carried along stays
// in a register. The columns are dealt from the last work-item down: the first is busy with the
// next sweep, and its neighbours wait for it.
INLINE void rotate_rows(global real* vectors, local const real* rotations, int l, int m, int n,
                        int pitch) {
  for (int base = 0; base < n; base += WG) {  // as many turns in every work-item
    const int j = base + WG - 1 - get_local_id(0);
    if (j >= n) continue;
    global real* row = vectors + m * (size_t)pitch + j;
    real carried = *row;
    for (int i = m - 1; i >= l; --i, row -= pitch) {
      const real entry = row[-pitch], c = rotations[i], s = rotations[pitch + i];
      *row = fma(s, entry, c * carried);
      carried = fma(c, entry, -(s * carried));
    }
    *row = carried;
  }
}

// The values in d by decreasing size, and the place of each among them; the sort is stable, so
// equal values keep their order. Clears the padding.
INLINE void sort_values(local const real* d, global real* values, global int* places, real scale,
                        int n, int pitch) {
  for (int base = 0; base < pitch; base += WG) {
    const int i = base + get_local_id(0);
    if (i >= pitch) continue;
    int place = 0;
    for (int j = 0; j < n && i < n; ++j) place += d[j] > d[i] || (d[j] == d[i] && j < i);
    places[i] = place;
    values[i < n ? place : i] = i < n ? scale * d[i] : 0;
  }
}

// The first work-item computes the rotations of a sweep while all others apply those of the sweep
// before; hence two lists. Local memory: 6 vectors [pitch] and 4 reals, all of it an argument: PoCL
// 3.1 reads stale values of a local variable of the kernel that one work-item writes.
kernel __attribute__((reqd_work_group_size(WG, 1, 1))) void group_diagonalise(
    global const segment_t* segments,  // [segments]
    global const int* active,          // [active segments]
    global const int* chosen,          // [segments]: 0 leaves a segment as it is
    global const real* diagonal,       // d, one vector per segment
    global const real* off_diagonal,   // e, likewise
    global const real* scales,         // [segments]
    global real* vectors,              // V, order x order matrices
    global real* values,               // eigenvalues
    global int* places,                // vectors of ints: row i of V belongs to values[places[i]]
    global int* failed,                // [segments]: set to 1 where QL gave up
    local real* memory) {
  const int b = active[get_group_id(0)], lane = get_local_id(0);
  if (!chosen[b]) return;  // uniform
  const segment_t s = segments[b];
  const int n = s.order, pitch = s.order_pitch;
  local real* d = memory;
  local real* e = d + pitch;
  local real* rotations = e + pitch;  // two lists of c [pitch] and s [pitch]
  local int2* range = (local int2*)(rotations + 4 * pitch);
  local progress_t* progress = (local progress_t*)(range + 2);

  for (int base = 0; base < n; base += WG) {  // T turned around
    const int i = base + lane;
    if (i >= n) continue;
    d[i] = diagonal[s.vector + n - 1 - i];
    e[i] = i < n - 1 ? off_diagonal[s.vector + n - 2 - i] : 0;
  }
  *progress = (progress_t){0, -1, 0};
  range[0] = (int2)(0, 0);       // a sweep without rotations, while the first is computed
  barrier(CLK_LOCAL_MEM_FENCE);  // d, e, progress and range are written
  int now = 0;
  while (range[now].y >= 0) {  // uniform: every work-item reads the same
    const int2 sweep = range[now];
    local real* next = rotations + 2 * pitch * (1 - now);
    if (lane == 0) range[1 - now] = next_sweep(d, e, next, progress, n, pitch);
    rotate_rows(vectors + s.square, rotations + 2 * pitch * now, sweep.x, sweep.y, n, pitch);
    barrier(CLK_LOCAL_MEM_FENCE);  // the next list is written, this one has been read
    now = 1 - now;
  }
  if (progress->first < n) failed[b] = 1;
  sort_values(d, values + s.vector, places + s.vector, scales[b], n, pitch);
}

// The rows of V with one of the wanted[b] largest values into Z, and zeros into its padding.
kernel __attribute__((reqd_work_group_size(WG, 1, 1))) void group_sort(
    global const segment_t* segments,  // [segments]
    global const int* active,          // [active segments]
    global const int* wanted,          // [segments]
    global const real* vectors,        // V, order x order matrices
    global const int* places,          // vectors of ints
    global real* z) {                  // eigenvectors in rows, order x order matrices
  const int b = active[get_group_id(0)];
  const segment_t s = segments[b];
  const size_t pitch = s.order_pitch;
  for (int i = 0; i < s.order; ++i) {
    const int place = places[s.vector + i];
    for (int j = get_local_id(0); place < wanted[b] && j < s.order_pitch; j += WG)
      z[s.square + place * pitch + j] = j < s.order ? vectors[s.square + i * pitch + j] : 0;
  }
}
