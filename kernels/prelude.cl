// Prepended to every program: the number type, explicit vectors of VW reals, and the segment
// record.
//
// VW is the device's native vector width: compilers that do not vectorise across work-items (PoCL)
// still fill their vector units, and a device that works on scalars gets VW = 1.

#ifndef REAL
#error "REAL is not defined: the number type, double"
#endif
#ifndef VW
#error "VW is not defined: reals per vector, 1, 2, 4 or 8"
#endif
#ifndef BLOCK_ROWS
#error "BLOCK_ROWS is not defined: rows of a segment that one work-item handles in a sweep"
#endif

#pragma OPENCL EXTENSION cl_khr_fp64 : enable

typedef REAL real;

#define JOIN_(a, b) a##b
#define JOIN(a, b) JOIN_(a, b)

#if VW == 1
typedef real vreal;
inline vreal load(global const real* p) { return *p; }
inline void store(global real* p, vreal v) { *p = v; }
#else
typedef JOIN(REAL, VW) vreal;
inline vreal load(global const real* p) { return *(global const vreal*)p; }
inline void store(global real* p, vreal v) { *(global vreal*)p = v; }
#endif

// Sum of the lanes in one fixed order.
inline real lane_sum(vreal v) {
#if VW == 1
  return v;
#elif VW == 2
  return v.s0 + v.s1;
#elif VW == 4
  return (v.s0 + v.s1) + (v.s2 + v.s3);
#else
  return ((v.s0 + v.s1) + (v.s2 + v.s3)) + ((v.s4 + v.s5) + (v.s6 + v.s7));
#endif
}

inline real lane_max(vreal v) {
#if VW == 1
  return v;
#elif VW == 2
  return fmax(v.s0, v.s1);
#elif VW == 4
  return fmax(fmax(v.s0, v.s1), fmax(v.s2, v.s3));
#else
  return fmax(fmax(fmax(v.s0, v.s1), fmax(v.s2, v.s3)), fmax(fmax(v.s4, v.s5), fmax(v.s6, v.s7)));
#endif
}

// One segment of a batch; mirrors moclean::SegmentRecord (host/moclean/linalg/batch.hpp).
typedef struct {
  long first_row;   // its first row in the stacked matrices
  long square;      // offset of its order x order matrices, in reals
  long vector;      // offset of its vectors of `order` entries, in reals
  int rows;         // frames
  int columns;      // of the batch
  int pitch;        // reals from one row of a stacked matrix to the next
  int order;        // min(rows, columns): size of its Gram matrix
  int order_pitch;  // reals from one row of an order x order matrix to the next
  int first_block;  // index of its first block of BLOCK_ROWS rows among all blocks of the batch
} segment_t;

// One block of rows: work of one work-item in a sweep.
typedef struct {
  int segment;
  int block;  // counted within the segment
} block_t;

inline int is_wide(const segment_t s) { return s.rows < s.columns; }

inline int block_begin(const block_t b) { return b.block * BLOCK_ROWS; }

inline int block_end(const block_t b, const segment_t s) {
  return min(s.rows, (b.block + 1) * BLOCK_ROWS);
}
