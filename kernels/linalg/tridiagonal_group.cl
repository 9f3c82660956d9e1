// Reduction of many symmetric matrices to tridiagonal form, A = Q T Q', by Householder reflections
// (Golub and Van Loan, 8.3.1), a work-group of WG work-items per matrix: the form for GPUs.
//
//   Q = H_0 H_1 .. H_{n-2}    H_k = I - u u',  |u|^2 = 2,  u zero up to k
//
// A is scaled by a power of two to entries below 2. Columns are dealt to the work-items, so that
// neighbours touch neighbouring reals of a row, and every sum has one order: the result depends on
// nothing but WG and the matrix. TRIANGLE_IN_LOCAL chooses where the upper triangle lies meanwhile:
// packed by rows in local memory (n (n + 1) / 2 reals), or in A itself, for larger n; the results
// agree bit for bit. The steps are those of householder.cl, as in tridiagonal.cl.
// Launch: WG work-items per active segment.
//
// Loops over columns make as many turns in every work-item, although some turns find nothing to do,
// and a scalar of the matrix is written by every work-item alike: PoCL 3.1 follows a branch that
// depends on the work-item past the next barrier, and loses what is done there.
//
// Notation: d, e diagonal and off-diagonal of T; v, w: the update A - v w' - w v' of one step, done
// together with the product of the next.

#ifndef WG
#error "WG is not defined: work-items of a work-group, a power of two"
#endif
#ifndef TRIANGLE_IN_LOCAL
#error "TRIANGLE_IN_LOCAL is not defined: 1 to reduce a matrix in local memory, 0 in global"
#endif

// Contraction is left to no compiler: fma stands where it is meant.
#pragma OPENCL FP_CONTRACT OFF

#define ENTRY real
#include "linalg/householder.cl"

// t[row_start(i, width) + j] is the entry (i, j), j >= i; width is n packed, the pitch otherwise.
#if TRIANGLE_IN_LOCAL
#define TRIANGLE local
#define TRIANGLE_FENCE CLK_LOCAL_MEM_FENCE
INLINE size_t row_start(int i, int width) { return i * (2 * width - 1 - i) / 2; }
#else
#define TRIANGLE global
#define TRIANGLE_FENCE (CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE)
INLINE size_t row_start(int i, int width) { return i * (size_t)width; }
#endif

// Sum of x over the work-group, the same in every work-item: each adds up all WG terms, in one
// order, which saves a tree's barriers. partial: [WG]
INLINE real group_sum(real x, local real* partial) {
  barrier(CLK_LOCAL_MEM_FENCE);  // the last terms have been read
  partial[get_local_id(0)] = x;
  barrier(CLK_LOCAL_MEM_FENCE);  // all terms are written
  real sum = 0;
  for (int i = 0; i < WG; ++i) sum += partial[i];
  return sum;
}

INLINE real group_max(real x, local real* partial) {
  barrier(CLK_LOCAL_MEM_FENCE);
  partial[get_local_id(0)] = x;
  barrier(CLK_LOCAL_MEM_FENCE);
  real largest = partial[0];
  for (int i = 1; i < WG; ++i) largest = fmax(largest, partial[i]);
  return largest;
}

// t = A over the returned power of two.
INLINE real load_scaled(global const real* a, TRIANGLE real* t, local real* partial, int n,
                        int pitch, int width) {
  real largest = 0;
  for (int base = 0; base < n; base += WG) {
    const int j = base + get_local_id(0);
    for (int i = 0; i <= j && j < n; ++i) largest = fmax(largest, fabs(a[i * (size_t)pitch + j]));
  }
  const scale_t scale = scale_of(group_max(largest, partial));
  for (int base = 0; base < n; base += WG) {
    const int j = base + get_local_id(0);
    for (int i = 0; i <= j && j < n; ++i)
      t[row_start(i, width) + j] = scaled(a[i * (size_t)pitch + j], scale);
  }
  return scale.power;
}

// u = row k of the updated triangle; returns the sum of squares of its entries past k + 1.
INLINE real update_row(TRIANGLE const real* row, local const real* v, local const real* w,
                       local real* u, local real* partial, int k, int n) {
  real rest = 0;
  for (int base = k; base < n; base += WG) {
    const int j = base + get_local_id(0);
    if (j >= n) continue;
    const real entry = updated(row[j], v[k], w[k], v[j], w[j]);
    if (j > k + 1) rest = fma(entry, entry, rest);
    u[j] = entry;
  }
  return group_sum(rest, partial);
}

// u = x scaled so that H x = (e, 0, ..) for the entries k + 1 .. of x, which u holds; returns e.
// rest: sum of the squares of all but the first.
INLINE real reflector(local real* u, real rest, int k, int n) {
  const real first = u[k + 1];
  const reflector_t h = reflector_of(first, rest);
  barrier(CLK_LOCAL_MEM_FENCE);  // u[k + 1] has been read
  for (int base = k + 1; base < n; base += WG) {
    const int j = base + get_local_id(0);
    if (j < n) u[j] = h.scale * (j == k + 1 ? first - h.e : u[j]);
  }
  barrier(CLK_LOCAL_MEM_FENCE);  // u is written
  return h.e;
}

// For the rows and columns past k: t -= v w' + w v' (the previous step's update, delayed until the
// entries are read anyway), and p = t u.
INLINE void update_and_multiply(TRIANGLE real* t, local const real* v, local const real* w,
                                local const real* u, local real* p, int k, int n, int width) {
  for (int base = k + 1; base < n; base += WG) {
    const int j = base + get_local_id(0);
    if (j >= n) continue;
    real sum = 0;
    for (int i = k + 1; i <= j; ++i) {
      TRIANGLE real* entry = t + row_start(i, width) + j;
      *entry = updated(*entry, v[i], w[i], v[j], w[j]);
      sum = fma(u[i], *entry, sum);
    }
    p[j] = sum;
  }
  barrier(TRIANGLE_FENCE);  // the columns are updated before they are read as rows
  for (int base = k + 1; base < n; base += WG) {
    const int j = base + get_local_id(0);
    if (j >= n) continue;
    TRIANGLE const real* mirrored = t + row_start(j, width);
    real sum = p[j];
    for (int i = j + 1; i < n; ++i) sum = fma(u[i], mirrored[i], sum);
    p[j] = sum;
  }
}

// w = p - (p . u / 2) u and v = u, of this step.
INLINE void next_update(local real* v, local real* w, local const real* u, local const real* p,
                        local real* partial, int k, int n) {
  real product = 0;
  for (int base = k + 1; base < n; base += WG) {
    const int j = base + get_local_id(0);
    if (j < n) product = fma(p[j], u[j], product);
  }
  const real half_product = (real)0.5 * group_sum(product, partial);
  for (int base = k + 1; base < n; base += WG) {
    const int j = base + get_local_id(0);
    if (j >= n) continue;
    v[j] = u[j];
    w[j] = update_vector(p[j], u[j], half_product);
  }
}

// Local memory: 4 vectors [pitch], partial sums [WG] and, if TRIANGLE_IN_LOCAL, the triangle.
kernel __attribute__((reqd_work_group_size(WG, 1, 1))) void group_tridiagonalise(
    global const segment_t* segments,  // [segments]
    global const int* active,          // [active segments]
    global const int* chosen,          // [segments]: 0 leaves a segment as it is
    global real* a,                    // upper triangles -> u of reflector k in row k, past k
    global real* diagonal,             // d, one vector per segment
    global real* off_diagonal,         // e, likewise
    global real* scales,               // [segments]: what d and e are to be multiplied with
    local real* memory) {
  const int b = active[get_group_id(0)];
  if (!chosen[b]) return;  // uniform
  const segment_t s = segments[b];
  const int lane = get_local_id(0), n = s.order, pitch = s.order_pitch;
  global real* matrix = a + s.square;
  global real* d = diagonal + s.vector;
  global real* e = off_diagonal + s.vector;
  local real* u = memory;
  local real* v = u + pitch;
  local real* w = v + pitch;
  local real* p = w + pitch;
  local real* partial = p + pitch;
#if TRIANGLE_IN_LOCAL
  local real* t = partial + WG;
  const int width = n;
#else
  global real* t = matrix;
  const int width = pitch;
#endif

  const real scale = load_scaled(matrix, t, partial, n, pitch, width);
  scales[b] = scale;
  for (int base = 0; base < n; base += WG)
    if (base + lane < n) v[base + lane] = w[base + lane] = 0;
  barrier(CLK_GLOBAL_MEM_FENCE);  // A has been read
  for (int k = 0; k < n - 1; ++k) {
    barrier(TRIANGLE_FENCE);  // v, w and the triangle are written, u has been read
    const real rest = update_row(t + row_start(k, width), v, w, u, partial, k, n);
    d[k] = u[k];
    const real off = reflector(u, rest, k, n);
    e[k] = off;
    for (int base = k + 1; base < n; base += WG)
      if (base + lane < n) matrix[k * (size_t)pitch + base + lane] = u[base + lane];
    update_and_multiply(t, v, w, u, p, k, n, width);
    next_update(v, w, u, p, partial, k, n);
  }
  barrier(TRIANGLE_FENCE);  // v and w are written
  d[n - 1] = fma(-2 * v[n - 1], w[n - 1], t[row_start(n - 1, width) + n - 1]);
}
