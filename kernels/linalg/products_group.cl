// Products of a segment X [rows x columns] with its square matrices of size `order`, a work-group
// of WG work-items per tile of the result: the form for GPUs of products.cl.
//
//   gram         G = X'X, or XX' for a wide segment (rows < columns); upper tiles only
//   reconstruct  W = sum_k f_k z_k z_k'     z_k: row k of Z, k < terms
//   apply        A = XW,  or WX  for a wide segment
//   rotate       B = XZ', or ZX  for a wide segment
//   compose      C = PZ
//
// All are result(i, j) = sum_k left(i, k) right(j, k). A tile has TILE_DOWN x TILE_ACROSS entries;
// SLICE values of k at a time come to local memory, and a work-item adds up 4 x 4 entries: columns
// 16 apart, so that neighbours touch neighbouring reals. Every sum runs over k in increasing order,
// whatever WG. The register tiles of products.cl have no step in common with these: they read rows
// of vectors where they lie. Launch: (WG x tiles across, tiles down, active segments).

#ifndef WG
#error "WG is not defined: work-items of a work-group, 16, 32, .. 256"
#endif

#define SLICE 16
#define TILE_DOWN (WG / 4)
#define TILE_ACROSS 64
// A slice is stored by k; the odd pitch spreads a fixed column over the banks of local memory.
#define LEFT_PITCH (TILE_DOWN + 1)
#define RIGHT_PITCH (TILE_ACROSS + 1)

typedef JOIN(REAL, 4) real4;

// A factor: entry (i, k) is at[i * along + k * deep], for i < count; zero elsewhere.
typedef struct {
  global const real* at;
  int along, deep, count;
} factor_t;

// Entries (first + i, k + l) of the factor to slice[l * (width + 1) + i], i < width, l < SLICE.
// Neighbouring work-items read neighbouring reals, in whichever direction the factor has them.
INLINE void load_slice(local real* slice, const factor_t factor, int first, const uint width, int k,
                       int depth) {
  for (uint base = 0; base < SLICE * width; base += WG) {
    const uint item = base + get_local_id(0);
    const uint i = factor.deep == 1 ? item / SLICE : item % width;
    const uint l = factor.deep == 1 ? item % SLICE : item / width;
    const int row = first + (int)i, deep = k + (int)l;
    const int inside = row < factor.count && deep < depth;
    slice[l * (width + 1) + i] =
        inside ? factor.at[row * (size_t)factor.along + deep * (size_t)factor.deep] : 0;
  }
}

INLINE void store_row(global real* target, const real4 sum, int row, int rows, int column,
                      int pitch) {
  global real* entry = target + row * (size_t)pitch + column;
  if (row < rows && column < pitch) entry[0] = sum.s0;
  if (row < rows && column + 16 < pitch) entry[16] = sum.s1;
  if (row < rows && column + 32 < pitch) entry[32] = sum.s2;
  if (row < rows && column + 48 < pitch) entry[48] = sum.s3;
}

// The tile of the result that belongs to this work-group, k < depth, weighted where there is a
// weight; its columns reach to the pitch, so that padding becomes zero.
INLINE void multiply(const factor_t left, const factor_t right, global const real* weight,
                     int depth, global real* target, int pitch, local real* l, local real* r) {
  const int down = get_global_id(1) * TILE_DOWN, across = get_group_id(0) * TILE_ACROSS;
  const uint lane = get_local_id(0);  // unsigned: quotient and remainder are a shift and a mask
  const int row = lane / 16 * 4, column = lane % 16;
  real4 sum0 = 0, sum1 = 0, sum2 = 0, sum3 = 0;
  for (int k = 0; k < depth; k += SLICE) {
    barrier(CLK_LOCAL_MEM_FENCE);  // the last slices have been read
    load_slice(l, left, down, TILE_DOWN, k, depth);
    load_slice(r, right, across, TILE_ACROSS, k, depth);
    barrier(CLK_LOCAL_MEM_FENCE);  // the slices are written
    for (int i = 0; i < min(SLICE, depth - k); ++i) {
      local const real* b = r + i * RIGHT_PITCH + column;
      local const real* a = l + i * LEFT_PITCH + row;
      const real w = weight ? weight[k + i] : 1;
      const real4 factor = (real4)(b[0], b[16], b[32], b[48]);
      sum0 = fma((real4)(w * a[0]), factor, sum0);
      sum1 = fma((real4)(w * a[1]), factor, sum1);
      sum2 = fma((real4)(w * a[2]), factor, sum2);
      sum3 = fma((real4)(w * a[3]), factor, sum3);
    }
  }
  store_row(target, sum0, down + row, left.count, across + column, pitch);
  store_row(target, sum1, down + row + 1, left.count, across + column, pitch);
  store_row(target, sum2, down + row + 2, left.count, across + column, pitch);
  store_row(target, sum3, down + row + 3, left.count, across + column, pitch);
}

kernel __attribute__((reqd_work_group_size(WG, 1, 1))) void gram(
    global const segment_t* segments,  // [segments]
    global const int* active,          // [active segments]
    global const real* x,              // [rows x pitch] stacked
    global real* g) {                  // order x order matrices; upper triangle written
  local real l[SLICE * LEFT_PITCH], r[SLICE * RIGHT_PITCH];
  const segment_t s = segments[active[get_global_id(2)]];
  const int wide = is_wide(s), along = wide ? s.pitch : 1, deep = wide ? 1 : s.pitch;
  // A tile below the diagonal has no rows.
  const int below = get_global_id(1) * TILE_DOWN >= (get_group_id(0) + 1) * TILE_ACROSS;
  const int depth = below ? 0 : wide ? s.columns : s.rows;
  const factor_t left = {x + s.first_row * s.pitch, along, deep, below ? 0 : s.order};
  const factor_t right = {x + s.first_row * s.pitch, along, deep, s.order};
  multiply(left, right, 0, depth, g + s.square, s.order_pitch, l, r);
}

kernel __attribute__((reqd_work_group_size(WG, 1, 1))) void reconstruct(
    global const segment_t* segments,  // [segments]
    global const int* active,          // [active segments]
    global const real* z,              // eigenvectors in rows, order x order
    global const real* f,              // weights, `order` per segment
    global const int* terms,           // [segments]
    global real* w) {                  // order x order matrices
  local real l[SLICE * LEFT_PITCH], r[SLICE * RIGHT_PITCH];
  const int b = active[get_global_id(2)];
  const segment_t s = segments[b];
  const factor_t factor = {z + s.square, 1, s.order_pitch, s.order};
  multiply(factor, factor, f + s.vector, min(terms[b], s.order), w + s.square, s.order_pitch, l, r);
}

// The product of the stacked X and a square matrix, whose entry (i, j) is at[i * row + j * column].
INLINE void multiply_stacked(const segment_t s, global const real* x, global const real* square,
                             int row, int column, global real* result, local real* l,
                             local real* r) {
  const factor_t rows_of_x = {x + s.first_row * s.pitch, s.pitch, 1, s.rows};
  const factor_t columns_of_x = {x + s.first_row * s.pitch, 1, s.pitch, s.columns};
  const factor_t rows_of_square = {square + s.square, row, column, s.order};
  const factor_t columns_of_square = {square + s.square, column, row, s.order};
  multiply(is_wide(s) ? rows_of_square : rows_of_x, is_wide(s) ? columns_of_x : columns_of_square,
           0, s.order, result + s.first_row * s.pitch, s.pitch, l, r);
}

kernel __attribute__((reqd_work_group_size(WG, 1, 1))) void apply(
    global const segment_t* segments,  // [segments]
    global const int* active,          // [active segments]
    global const real* x,              // [rows x pitch] stacked
    global const real* w,              // order x order matrices
    global real* a) {                  // [rows x pitch] stacked
  local real l[SLICE * LEFT_PITCH], r[SLICE * RIGHT_PITCH];
  const segment_t s = segments[active[get_global_id(2)]];
  multiply_stacked(s, x, w, s.order_pitch, 1, a, l, r);
}

kernel __attribute__((reqd_work_group_size(WG, 1, 1))) void rotate_into(
    global const segment_t* segments,  // [segments]
    global const int* active,          // [active segments]
    global const real* x,              // [rows x pitch] stacked
    global const real* z,              // order x order matrices
    global real* b) {                  // [rows x pitch] stacked
  local real l[SLICE * LEFT_PITCH], r[SLICE * RIGHT_PITCH];
  const segment_t s = segments[active[get_global_id(2)]];
  const int wide = is_wide(s);
  multiply_stacked(s, x, z, wide ? s.order_pitch : 1, wide ? 1 : s.order_pitch, b, l, r);
}

kernel __attribute__((reqd_work_group_size(WG, 1, 1))) void compose(
    global const segment_t* segments,  // [segments]
    global const int* active,          // [active segments]
    global const real* p,              // order x order matrices
    global const real* z,              // order x order matrices
    global real* c) {                  // order x order matrices
  local real l[SLICE * LEFT_PITCH], r[SLICE * RIGHT_PITCH];
  const segment_t s = segments[active[get_global_id(2)]];
  const factor_t left = {p + s.square, s.order_pitch, 1, s.order};
  const factor_t right = {z + s.square, 1, s.order_pitch, s.order};
  multiply(left, right, 0, s.order, c + s.square, s.order_pitch, l, r);
}
