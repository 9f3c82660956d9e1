// Prepended to every program: the number type, explicit vectors of VW reals, and the segment
// record.
//
// VW is the device's native vector width: compilers that do not vectorise across work-items (PoCL)
// still fill their vector units, and a device that works on scalars gets VW = 1.

#ifndef REAL
#error "REAL is not defined: the number type of matrices, double or float"
#endif
#ifndef VW
#error "VW is not defined: reals per vector, 1, 2, 4, 8 or 16"
#endif
#ifndef BLOCK_ROWS
#error "BLOCK_ROWS is not defined: most rows of a segment that one work-item handles in a sweep"
#endif

#pragma OPENCL EXTENSION cl_khr_fp64 : enable

// Loops over a constant parameter unroll where a compiler inlines; one that does not optimise
// warns.
#ifdef __clang__
#pragma clang diagnostic ignored "-Wpass-failed"
#endif

typedef REAL real;  // of matrices; sums over a segment and its scalars are double in any case

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

// For functions with arrays that are to stay in registers: one that is not inlined has them in
// memory.
#define INLINE inline __attribute__((always_inline))

// A hint to caches; no effect on results.
#if VW > 1
#define PREFETCH(p) __builtin_prefetch(p)
#else
#define PREFETCH(p) ((void)(p))
#endif

// Sum of the lanes in one fixed order.
inline real lane_sum(vreal v) {
#if VW == 1
  return v;
#elif VW == 2
  return v.s0 + v.s1;
#elif VW == 4
  return (v.s0 + v.s1) + (v.s2 + v.s3);
#elif VW == 8
  return ((v.s0 + v.s1) + (v.s2 + v.s3)) + ((v.s4 + v.s5) + (v.s6 + v.s7));
#else
  const JOIN(REAL, 8) u = v.lo + v.hi;
  return ((u.s0 + u.s1) + (u.s2 + u.s3)) + ((u.s4 + u.s5) + (u.s6 + u.s7));
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
#if VW == 16
  const JOIN(REAL, 8) u = fmax(v.lo, v.hi);
#else
  const vreal u = v;
#endif
  return fmax(fmax(fmax(u.s0, u.s1), fmax(u.s2, u.s3)), fmax(fmax(u.s4, u.s5), fmax(u.s6, u.s7)));
#endif
}

// One segment of a batch; mirrors moclean::SegmentRecord (host/moclean/linalg/batch.hpp).
typedef struct {
  long first_row;   // its first row in the stacked matrices
  long square;      // offset of its order x order matrices, in reals
  long vector;      // offset of its vectors of `order` entries, in reals
  long partial;     // offset of the partial Gram matrices of all blocks but its first, in reals
  int rows;         // frames
  int columns;      // of the batch
  int pitch;        // reals from one row of a stacked matrix to the next
  int order;        // min(rows, columns): size of its Gram matrix
  int order_pitch;  // reals from one row of an order x order matrix to the next
  int first_block;  // index of its first block among all blocks of the batch
} segment_t;

// One block of rows: work of one work-item in a sweep. The rows of a segment are divided into as
// few blocks of at most BLOCK_ROWS as possible, of equal size but for rounding to whole tiles.
typedef struct {
  int segment;
  int block;  // counted within the segment
} block_t;

inline int is_wide(const segment_t s) { return s.rows < s.columns; }

inline int block_count_of(const segment_t s) { return (s.rows + BLOCK_ROWS - 1) / BLOCK_ROWS; }

inline int block_begin(const block_t b, const segment_t s) {
  const int blocks = block_count_of(s);
  return min(s.rows, b.block * (((s.rows + blocks - 1) / blocks + 7) / 8 * 8));
}

inline int block_end(const block_t b, const segment_t s) {
  const block_t next = {b.segment, b.block + 1};
  return next.block == block_count_of(s) ? s.rows : block_begin(next, s);
}

// The entries first .. last - 1 of a stacked matrix that belong to a block: one run of memory.
typedef struct {
  size_t first, last;
} entries_t;

INLINE entries_t entries_of(const block_t b, const segment_t s) {
  const entries_t entries = {(s.first_row + block_begin(b, s)) * s.pitch,
                             (s.first_row + block_end(b, s)) * s.pitch};
  return entries;
}
