// The form for GPUs of search_direction.cl: the next direction of conjugate gradients and its
// product, in the notation of conjugate_gradients.cl, a work-group of WG work-items per block of
// rows, on both sides of a product of its own (products_group.cl):
//
//   differences   p = z + beta p,  C = Delta'P Delta p
//   (apply        q = C R)
//   complete      q = W o p + q,   p.q per block
//
// Neighbouring work-items take neighbouring entries, across the rows of a block, which are one run
// of memory. A block has SUMS sums of p.q whatever WG, so that the result does not depend on it.
// An entry takes the steps of search_entry.cl. Launch: WG work-items per active block.

#define ENTRY real
#define LOAD(p) (*(p))
#include "matrix_normal/conjugate_sums.cl"
#include "matrix_normal/search_entry.cl"

#ifndef WG
#error "WG is not defined: work-items of a work-group, at most SUMS"
#endif

#define SUMS 256

// Entry (i, column) of Delta'P Delta p, given p0 = p(i, column).
INLINE real curvature(const search_t c, const segment_t s, int i, int column, real p0) {
  const int last = s.rows - 1;
  const real far = direction_at(c, s, max(i - 2, 0), column);
  const real near = direction_at(c, s, max(i - 1, 0), column);
  const real p1 = direction_at(c, s, min(i + 1, last), column);
  const real p2 = direction_at(c, s, min(i + 2, last), column);
  const real a2 = weighted_acceleration(c, i - 2, far, near, p0);
  const real a1 = weighted_acceleration(c, i - 1, near, p0, p1);
  const real a0 = weighted_acceleration(c, i, p0, p1, p2);
  return second_difference(a2, a1, a0);
}

kernel __attribute__((reqd_work_group_size(WG, 1, 1))) void differences(
    global const segment_t* segments,  // [segments]
    global const block_t* blocks,      // [active blocks]
    int block_count,                   // of active blocks
    global const real* z,              // [rows x pitch] stacked
    global const real* p_before,       // [rows x pitch] stacked
    global const real* precisions,     // P, one per row, stacked
    global const double* rz,           // [segments x vectors of columns]
    global const double* rz_before,    // [segments x vectors of columns]
    global const double* bz,           // [segments x vectors of columns]
    double tolerance,                  // negative: go on whatever r.z
    int begins,                        // beta = 0
    global real* p,                    // [rows x pitch] stacked
    global real* curvatures,           // C, [rows x pitch] stacked
    global int* iterations) {          // [segments]
  if ((int)get_group_id(0) >= block_count) return;
  const block_t block = blocks[get_group_id(0)];
  const segment_t s = segments[block.segment];
  const stage_t stage = stage_of(rz, rz_before, bz, block.segment, s, tolerance, begins);
  if (stage.enough) return;
  if (tolerance >= 0 && block.block == 0 && get_local_id(0) == 0) ++iterations[block.segment];
  const size_t begin = s.first_row * s.pitch;
  const search_t c = search_of(s, z, p_before, precisions, stage.beta);
  const uint pitch = s.pitch, end = block_end(block, s) * pitch;
  for (uint i = block_begin(block, s) * pitch + get_local_id(0); i < end; i += WG) {
    const int row = i / pitch, column = i - row * pitch;
    const real p0 = direction_at(c, s, row, column);
    p[begin + i] = p0;
    curvatures[begin + i] = curvature(c, s, row, column, p0);
  }
}

kernel __attribute__((reqd_work_group_size(WG, 1, 1))) void complete(
    global const segment_t* segments,  // [segments]
    global const block_t* blocks,      // [active blocks]
    int block_count,                   // of active blocks
    global const real* weights,        // W, [rows x pitch] stacked
    global const real* p,              // [rows x pitch] stacked
    global real* product,              // CR -> q, [rows x pitch] stacked
    global double* partial_pq) {       // [all blocks]
  local double sums[SUMS];
  if ((int)get_group_id(0) >= block_count) return;  // uniform
  const block_t block = blocks[get_group_id(0)];
  const segment_t s = segments[block.segment];
  const entries_t entries = entries_of(block, s);
  const int lane = get_local_id(0);
  for (int k = lane; k < SUMS; k += WG) {
    real sum = 0;
    for (size_t i = entries.first + k; i < entries.last; i += SUMS)
      product[i] = completed(weights[i], p[i], product[i], &sum);
    sums[k] = sum;
  }
  for (int width = SUMS / 2; width > 0; width /= 2) {
    barrier(CLK_LOCAL_MEM_FENCE);  // the sums so far are written
    for (int k = lane; k < width; k += WG) sums[k] += sums[k + width];
  }
  if (lane == 0) partial_pq[s.first_block + block.block] = sums[0];
}
