// Eigenvalues of many tridiagonal matrices T by implicit QL (Golub and Van Loan, 8.3.3), and the
// rotations that lead there, for the eigenvectors.
//
// A rotation needs a root and a division whose results the next one waits for. A work-item takes VW
// matrices, one to a lane, so that VW such chains share the wait. Lanes go their own ways: each has
// its own block l .. m of T, and a lane that is not within its block at index i keeps what it has.
// The result for a matrix does not depend on the other lanes.
//
// The rotations of a sweep are appended to the list of its matrix as they come, from m - 1 down to
// l: (p, s) of rotation i stands 2 (m - 1 - i) reals past the first, p = tan(angle / 2) = s / (1 +
// c). The sign of the off-diagonals is chosen so that no cosine is negative, thus |p| <= 1. Launch:
// one work-item per VW active segments.
//
// Notation: d, e diagonal and off-diagonal of T; rotation i, (c, s), acts on rows i and i + 1.

#ifndef SWEEPS_PER_ROW
#error "SWEEPS_PER_ROW is not defined: QL sweeps allowed, per row of the matrix"
#endif
#ifndef ROTATIONS_PER_ENTRY
#error "ROTATIONS_PER_ENTRY is not defined: rotations allowed, per entry of the matrix"
#endif

#ifndef NEGLIGIBLE
#error \
    "NEGLIGIBLE is not defined: size of an off-diagonal relative to its neighbours that is dropped"
#endif

// Contraction is left to no compiler: fma stands where it is meant.
#pragma OPENCL FP_CONTRACT OFF

// Below this share of T, an off-diagonal is nothing whatever its neighbours are.
#define NOTHING ((real)1.2325951644078310e-32)

// Below this, a sum of squares has lost digits to underflow; T is of size 1.
#define NEGLIGIBLE_SQUARES ((real)1e-290)

#if VW == 1
typedef long vindex;
#define LANE(type, v, lane) (v)
#else
typedef JOIN(long, VW) vindex;
#define LANE(type, v, lane) (((private type*)&(v))[lane])
#endif

// 1 / sqrt(x) to a unit of rounding. Where the processor has an estimate, good to 2^-14, a power
// series takes it there, y (1 - h)^(-1/2) with h = 1 - x y^2: half the wait for a root and a
// division.
inline vreal inverse_root(vreal x) {
#if VW == 8 && defined(__AVX512F__)
  const vreal y = __builtin_ia32_rsqrt14pd512_mask(x, (vreal)0, 0xff);
  const vreal h = fma(-(x * y), y, (vreal)1);
  const vreal series = fma(h, fma(h, (vreal)(real)0.3125, (vreal)(real)0.375), (vreal)(real)0.5);
  return fma(y * h, series, y);
#else
  return 1 / sqrt(x);
#endif
}

// 1 / x for 1 <= x <= 2, to a unit of rounding.
inline vreal inverse(vreal x) {
#if VW == 8 && defined(__AVX512F__)
  const vreal y = __builtin_ia32_rcp14pd512_mask(x, (vreal)0, 0xff);
  const vreal h = fma(-x, y, (vreal)1);
  return fma(y * h, fma(h, fma(h, (vreal)1, (vreal)1), (vreal)1), y);
#else
  return 1 / x;
#endif
}

// VW matrices, one to a lane.
typedef struct {
  global real* d;  // of all lanes, interleaved: entry i of all of them is one vector
  global real* e;
  vreal floor;                    // square of an off-diagonal that is nothing
  int order[VW], l[VW], m[VW];    // block l .. m of T; m = l: nothing left to do
  int sweeps[VW], rotations[VW];  // recorded so far
  global real* list[VW];          // of the rotations of the next sweep
} lanes_t;

// Where a sweep stands in its lanes.
typedef struct {
  vindex first, m;  // `first` is the row of the last rotation: l unless the block falls apart
  vindex split;     // first row past l that the sweep has split off from the next one
  vreal sine, cosine, p, g;
  vreal d_above, e_above, d_done;  // d[i + 1], e[i + 1], both before the rotation, and new d[i + 2]
} chain_t;

// T of one lane.
typedef struct {
  const lanes_t* all;
  int lane;
} tridiagonal_t;

inline int negligible(const tridiagonal_t t, int i) {
  global const real* d = t.all->d + i * VW + t.lane;
  const real e = t.all->e[i * VW + t.lane];
  const real product = fabs(d[0] * d[VW]);
  return e * e <= fmax((real)(NEGLIGIBLE * NEGLIGIBLE) * product, LANE(real, t.all->floor, t.lane));
}

#define ENTRY vreal
#include "linalg/ql.cl"

// Moves a lane on to its next block of more than one row.
inline void find_block(lanes_t* t, int lane) {
  const int n = t->order[lane];
  const tridiagonal_t own = {t, lane};
  const int2 block = next_block(own, t->l[lane], t->m[lane], n);
  t->l[lane] = block.x < n ? block.x : 0;
  t->m[lane] = block.x < n ? block.y : 0;
}

// The tridiagonals of the lanes and their first blocks. An empty lane is a matrix of order 0.
inline void gather(global const segment_t* segments, global const int* active, int first, int count,
                   global const int* chosen, global const real* d, global const real* e,
                   global real* rotations, int rows, lanes_t* t) {
  for (int lane = 0; lane < VW; ++lane) {
    const int index = active[first + min(lane, count - 1)];
    const int n = lane < count && chosen[index] ? segments[index].order : 0;
    const long from = segments[index].vector;
    for (int i = 0; i < rows; ++i) {
      t->d[i * VW + lane] = i < n ? d[from + i] : 0;
      t->e[i * VW + lane] = i < n - 1 ? e[from + i] : 0;
    }
    t->order[lane] = n;
    t->l[lane] = t->sweeps[lane] = t->rotations[lane] = 0;
    t->m[lane] = -1;
    t->list[lane] = rotations + 2 * ROTATIONS_PER_ENTRY * segments[index].square;
  }
  vreal norm = 0;  // max |d_i| + |e_i|
  for (int i = 0; i < rows; ++i)
    norm = fmax(norm, fabs(load(t->d + i * VW)) + fabs(load(t->e + i * VW)));
  t->floor = (NOTHING * norm) * (NOTHING * norm);
  for (int lane = 0; lane < VW; ++lane) find_block(t, lane);
}

INLINE void start_sweep(const lanes_t* t, chain_t* chain, int high) {
  vreal d_l = 0, d_next = 0, e_l = 1, d_m = 0;
  for (int lane = 0; lane < VW; ++lane) {
    const int l = t->l[lane], m = t->m[lane];
    LANE(long, chain->first, lane) = l;
    LANE(long, chain->m, lane) = m;
    if (m == l) continue;
    LANE(real, d_l, lane) = t->d[l * VW + lane];
    LANE(real, d_next, lane) = t->d[(l + 1) * VW + lane];
    LANE(real, e_l, lane) = t->e[l * VW + lane];
    LANE(real, d_m, lane) = t->d[m * VW + lane];
  }
  chain->g = shifted_end(d_l, d_next, e_l, d_m);
  chain->sine = chain->cosine = 1;
  chain->p = chain->d_done = 0;
  chain->split = chain->m;
  chain->d_above = load(t->d + high * VW);
  chain->e_above = load(t->e + high * VW);
}

// (p, s) of every lane to list[lane] + at.
INLINE void append(global real* const* list, long at, vreal p, vreal s) {
#if VW == 1
  list[0][at] = p;
  list[0][at + 1] = s;
#else
  vreal even, odd;  // pairs of the even and the odd lanes
  even.even = p.even;
  even.odd = s.even;
  odd.even = p.odd;
  odd.odd = s.odd;
#define PUT(lane, pair) *(global JOIN(REAL, 2)*)(list[lane] + at) = pair
#if VW == 2
  PUT(0, even);
  PUT(1, odd);
#else
  PUT(0, even.s01);
  PUT(1, odd.s01);
  PUT(2, even.s23);
  PUT(3, odd.s23);
#if VW == 8
  PUT(4, even.s45);
  PUT(5, odd.s45);
  PUT(6, even.s67);
  PUT(7, odd.s67);
#endif
#endif
#endif
}

// Rotation i of every lane. What the next one waits for is short: g, the inverse root, t, g.
INLINE void rotate(chain_t* b, const lanes_t* t, global real* const* list, int i) {
  const vindex inside = (vindex)i >= b->first && (vindex)i < b->m;
  const vindex inner = inside && (vindex)(i + 1) < b->m;
  const vreal d_here = load(t->d + i * VW), e_here = load(t->e + i * VW);
  const vreal f = b->sine * e_here, h = b->cosine * e_here;
  const vreal squares = fma(b->g, b->g, f * f);
  const vreal root = copysign(inverse_root(squares), b->g);  // of the sign of g, inverse
  const vindex rotated = inside && !(squares <= NEGLIGIBLE_SQUARES);
  const vreal lifted = inside ? b->d_above - b->p : b->d_above;
  const vreal turn = fma(d_here - lifted, f, 2 * h * b->g) * root;
  b->sine = rotated ? f * root : b->sine;
  b->cosine = rotated ? b->g * root : b->cosine;
  b->p = rotated ? b->sine * turn : b->p;
  b->g = rotated ? fma(b->cosine, turn, -h) : b->g;
  append(list, -2 * (long)i, b->sine * inverse(1 + b->cosine), b->sine);

  const vreal d_new = rotated ? lifted + b->p : lifted;
  const vreal product = (real)(NEGLIGIBLE * NEGLIGIBLE) * fabs(d_new * b->d_done);
  b->split = inner && squares <= fmax(product, t->floor) ? (vindex)(i + 1) : b->split;
  store(t->d + (i + 1) * VW, d_new);
  store(t->e + (i + 1) * VW, inside ? (inner && rotated ? squares * root : (vreal)0) : b->e_above);
  b->d_done = d_new;
  // A block that falls apart here ends at i + 1; one that reaches its end keeps what is left over.
  const vindex ends = rotated && (vindex)i == b->first;
  b->first = inside && !rotated ? (vindex)(i + 1) : b->first;
  b->d_above = ends ? d_here - b->p : d_here;
  b->e_above = ends ? b->g : e_here;
}

// One implicit QL sweep of every lane on its block, all within rows low .. high. A lane that is not
// in its block yet writes its rotations to `dump`; one that is past it, behind those of the sweep.
INLINE void sweep(const lanes_t* t, chain_t* chain, global real* dump, int low, int high) {
  start_sweep(t, chain, high);
  for (int from = high, to = low; from > low; from = to, to = low) {
    global real* list[VW];
#pragma unroll
    for (int lane = 0; lane < VW; ++lane) {
      const int m = t->m[lane], begun = m >= from;
      list[lane] = begun ? t->list[lane] + 2 * (m - 1) : dump + 2 * (high - 1);
      to = begun ? to : max(to, m);
    }
    for (int i = from - 1; i >= to; --i) rotate(chain, t, list, i);
  }
  store(t->d + low * VW, chain->d_above);
  store(t->e + low * VW, chain->e_above);
}

// Records the sweep that a lane has done and finds its next block. Returns 0 if there is no room
// for the rotations of another: QL does not converge.
inline int finish_sweep(lanes_t* t, const chain_t* chain, int lane, const segment_t s,
                        global int* sweeps) {
  const int first = LANE(long, chain->first, lane), m = t->m[lane];
  global int* done = sweeps + 2 * (SWEEPS_PER_ROW * s.vector + t->sweeps[lane]);
  done[0] = first;
  done[1] = m;
  t->sweeps[lane] += 1;
  t->rotations[lane] += m - first;
  t->list[lane] += 2 * (m - first);
  t->m[lane] = LANE(long, chain->split, lane);
  find_block(t, lane);
  const long room = (long)ROTATIONS_PER_ENTRY * s.order * s.order_pitch;
  return t->m[lane] == t->l[lane] || (t->sweeps[lane] < SWEEPS_PER_ROW * s.order_pitch &&
                                      t->rotations[lane] + t->m[lane] <= room);
}

// The eigenvalues by decreasing value, and where in T each of them stands; equal values keep their
// order. QL leaves them by increasing value as a rule, hence from the last.
inline void sort_values(global const real* d, int lane, real scale, int n, int pitch,
                        global real* values, global int* places) {
  for (int i = n - 1; i >= 0; --i) {
    const real value = scale * d[i * VW + lane];
    int rank = n - 1 - i;
    for (; rank > 0 && values[rank - 1] <= value; --rank) {
      values[rank] = values[rank - 1];
      places[rank] = places[rank - 1];
    }
    values[rank] = value;
    places[rank] = i;
  }
  for (int i = n; i < pitch; ++i) values[i] = 0;
}

kernel void diagonalise(global const segment_t* segments,  // [segments]
                        global const int* active,          // [active_count]
                        int active_count,
                        global const int* chosen,   // [segments]: 0 leaves a segment alone
                        int rows,                   // at least the largest order
                        global const real* d,       // `order` per segment
                        global const real* e,       // `order` - 1 per segment
                        global const real* scales,  // [segments]
                        global real* scratch,       // 4 x (rows + 1) x VW per work-item
                        global real* rotations,     // (p, s), ROTATIONS_PER_ENTRY per entry
                        global int* sweeps,         // first, m; SWEEPS_PER_ROW per row
                        global int* sweep_counts,   // [segments]
                        global real* values,        // `order` per segment
                        global int* places,         // `order` per segment
                        global int* failed) {       // [segments]: set to 1 where QL gave up
  const int first = VW * get_global_id(0);
  if (first >= active_count) return;
  const int count = min(VW, active_count - first);
  lanes_t lanes;
  lanes.d = scratch + 4 * (size_t)(rows + 1) * VW * get_global_id(0);
  lanes.e = lanes.d + (rows + 1) * VW;
  global real* dump = lanes.e + (rows + 1) * VW;
  gather(segments, active, first, count, chosen, d, e, rotations, rows + 1, &lanes);
  for (;;) {
    int low = rows, high = 0;
    for (int lane = 0; lane < VW; ++lane) {
      if (lanes.m[lane] == lanes.l[lane]) continue;
      low = min(low, lanes.l[lane]);
      high = max(high, lanes.m[lane]);
    }
    if (high == 0) break;
    chain_t chain;
    sweep(&lanes, &chain, dump, low, high);
    for (int lane = 0; lane < VW; ++lane) {
      if (lanes.m[lane] == lanes.l[lane]) continue;
      const int index = active[first + lane];
      if (finish_sweep(&lanes, &chain, lane, segments[index], sweeps)) continue;
      failed[index] = 1;
      lanes.l[lane] = lanes.m[lane] = 0;  // takes no more part
    }
  }
  for (int lane = 0; lane < count; ++lane) {
    const int index = active[first + lane];
    const segment_t segment = segments[index];
    if (!chosen[index]) continue;
    sweep_counts[index] = lanes.sweeps[lane];
    sort_values(lanes.d, lane, scales[index], segment.order, segment.order_pitch,
                values + segment.vector, places + segment.vector);
  }
}
