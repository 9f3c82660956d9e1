// Eigenvalues of many tridiagonal matrices T by implicit QL (Golub and Van Loan, 8.3.3), and the
// rotations that lead there, for the eigenvectors.
//
// A rotation needs a root and a division whose results the next one waits for. A work-item takes VW
// matrices, one to a lane, so that VW such chains share the wait. Lanes go their own ways: each has
// its own block l .. m of T, and a lane that is not within its block at index i keeps what it has.
// The result for a matrix does not depend on the other lanes.
// Launch: one work-item per VW active segments.
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

// Below this share of T, an off-diagonal is nothing whatever its neighbours are.
#define NOTHING ((real)1.2325951644078310e-32)

#if VW == 1
typedef long vindex;
#define ANY(mask) (mask)
#define LANE(v, lane) (v)
#define SET_LANE(v, lane, value) ((v) = (value))
#else
typedef JOIN(long, VW) vindex;
#define ANY(mask) any(mask)
#define LANE(v, lane) (((private const long*)&(v))[lane])
#define SET_LANE(v, lane, value) (((private long*)&(v))[lane] = (value))
#endif

// The block of every lane: rows l .. m of T, the first from l on that has not fallen apart.
typedef struct {
  vindex order, l, m;
  vindex first;                 // row of the first rotation of a sweep: l unless it fell apart
  vreal d_l, d_next, e_l, d_m;  // d[l], d[l + 1], e[l], d[m]
  vreal norm;                   // of T: max |d_i| + |e_i|
} block_of_lanes_t;

// The tridiagonals of the lanes, interleaved: entry i of all lanes is one vector. An empty lane is
// a matrix of order 0.
inline void gather(global const segment_t* segments, global const int* active, int first, int count,
                   global const int* chosen, global const real* d, global const real* e,
                   global real* dl, global real* el, int rows, block_of_lanes_t* b) {
  for (int lane = 0; lane < VW; ++lane) {
    const int index = active[first + min(lane, count - 1)];
    const int n = lane < count && chosen[index] ? segments[index].order : 0;
    const long from = segments[index].vector;
    SET_LANE(b->order, lane, n);
    for (int i = 0; i < rows; ++i) {
      dl[i * VW + lane] = i < n ? d[from + i] : 0;
      el[i * VW + lane] = i < n - 1 ? e[from + i] : 0;
    }
  }
  b->l = b->m = b->first = 0;
  b->d_l = b->d_next = b->e_l = b->d_m = b->norm = 0;
  for (int i = 0; i < rows; ++i)
    b->norm = fmax(b->norm, fabs(load(dl + i * VW)) + fabs(load(el + i * VW)));
}

// Moves every lane on to its next block from row `from` on, which is at most its l; l is its order
// when nothing is left. Returns whether
// any lane has a block. An off-diagonal is negligible relative to its neighbours, or next to
// nothing at all.
inline int find_blocks(global const real* d, global const real* e, int from, int rows,
                       block_of_lanes_t* b) {
  vindex opened = 0, closed = 0, l = b->order, m = b->order;
  const vreal floor = NOTHING * b->norm;
  vreal here = load(d + from * VW);
  for (int i = from; i < rows; ++i) {
    const vreal next = load(d + (i + 1) * VW), off = load(e + i * VW);
    const vindex apart = off * off <= (real)(NEGLIGIBLE * NEGLIGIBLE) * fabs(here) * fabs(next) ||
                         fabs(off) <= floor || (vindex)i >= b->order - 1;
    const vindex opens = !opened && !apart && (vindex)i >= b->l;
    const vindex closes = opened && !closed && apart;
    l = opens ? (vindex)i : l;
    b->d_l = opens ? here : b->d_l;
    b->d_next = opens ? next : b->d_next;
    b->e_l = opens ? off : b->e_l;
    m = closes ? (vindex)i : m;
    b->d_m = closes ? here : b->d_m;
    opened = opened || opens;
    closed = closed || closes;
    here = next;
  }
  b->l = l;
  b->m = m;
  return ANY(opened);
}

// One implicit QL sweep of every lane on its block; the rotations go to c and s.
inline void sweep(global real* d, global real* e, global real* c, global real* s, int low, int high,
                  block_of_lanes_t* b) {
  const vreal shift = (b->d_next - b->d_l) / (2 * b->e_l);
  vreal g = b->d_m - b->d_l + b->e_l / (shift + copysign(sqrt(fma(shift, shift, (vreal)1)), shift));
  vreal sine = 1, cosine = 1, p = 0;
  b->first = b->l;
  vreal d_above = load(d + high * VW), e_above = load(e + high * VW);  // entries i + 1
  for (int i = high - 1; i >= low; --i) {
    const vindex inside = (vindex)i >= b->first && (vindex)i < b->m;
    const vreal d_here = load(d + i * VW), e_here = load(e + i * VW);
    const vreal f = sine * e_here, h = cosine * e_here;
    const vreal r = sqrt(fma(f, f, g * g));
    const vindex rotated = inside && r != 0;
    sine = rotated ? f / r : sine;
    cosine = rotated ? g / r : cosine;
    const vreal lifted = inside ? d_above - p : d_above;
    const vreal t = fma(d_here - lifted, sine, 2 * cosine * h);
    p = rotated ? sine * t : p;
    g = rotated ? fma(cosine, t, -h) : g;
    store(d + (i + 1) * VW, rotated ? lifted + p : lifted);
    store(e + (i + 1) * VW, inside ? ((vindex)(i + 1) < b->m ? r : (vreal)0) : e_above);
    store(c + i * VW, cosine);
    store(s + i * VW, sine);
    // A block that falls apart here ends at i + 1; one that reaches its end keeps what is left
    // over.
    const vindex ends = rotated && (vindex)i == b->first;
    b->first = inside && !rotated ? (vindex)(i + 1) : b->first;
    d_above = ends ? d_here - p : d_here;
    e_above = ends ? g : e_here;
  }
  store(d + low * VW, d_above);
  store(e + low * VW, e_above);
}

// What has been recorded of every lane so far.
typedef struct {
  int sweeps[VW], rotations[VW];
} counts_t;

// Appends the rotations first .. m - 1 of one lane to the lists of its segment. Returns 0, and
// appends nothing, if there is no room left: QL does not converge.
inline int record(const block_of_lanes_t* b, int lane, const segment_t s, global const real* c,
                  global const real* sines, global real* rotations, global int* sweeps,
                  counts_t* counts) {
  const int begin = LANE(b->first, lane), m = LANE(b->m, lane);
  const long room = (long)ROTATIONS_PER_ENTRY * s.order * s.order_pitch;
  if (counts->sweeps[lane] >= SWEEPS_PER_ROW * s.order_pitch ||
      counts->rotations[lane] + m - begin > room)
    return 0;
  global real* list = rotations + 2 * (ROTATIONS_PER_ENTRY * s.square + counts->rotations[lane]);
  for (int i = begin; i < m; ++i) {
    list[2 * (i - begin)] = c[i * VW + lane];
    list[2 * (i - begin) + 1] = sines[i * VW + lane];
  }
  global int* sweep = sweeps + 2 * (SWEEPS_PER_ROW * s.vector + counts->sweeps[lane]);
  sweep[0] = begin;
  sweep[1] = m;
  counts->rotations[lane] += m - begin;
  counts->sweeps[lane] += 1;
  return 1;
}

// The eigenvalues by decreasing value, and where in T each of them stands; equal values keep their
// order.
inline void sort_values(global const real* d, int lane, real scale, int n, int pitch,
                        global real* values, global int* places) {
  for (int i = 0; i < n; ++i) {
    const real value = scale * d[i * VW + lane];
    int rank = i;
    for (; rank > 0 && values[rank - 1] < value; --rank) {
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
                        global real* rotations,     // (c, s), ROTATIONS_PER_ENTRY per entry
                        global int* sweeps,         // first, m; SWEEPS_PER_ROW per row
                        global int* sweep_counts,   // [segments]
                        global real* values,        // `order` per segment
                        global int* places,         // `order` per segment
                        global int* failed) {       // [segments]: set to 1 where QL gave up
  const int first = VW * get_global_id(0);
  if (first >= active_count) return;
  const int count = min(VW, active_count - first);
  global real* dl = scratch + 4 * (size_t)(rows + 1) * VW * get_global_id(0);
  global real* el = dl + (rows + 1) * VW;
  global real* c = el + (rows + 1) * VW;
  global real* s = c + (rows + 1) * VW;
  block_of_lanes_t b;
  gather(segments, active, first, count, chosen, d, e, dl, el, rows + 1, &b);
  counts_t counts;
  for (int lane = 0; lane < VW; ++lane) counts.sweeps[lane] = counts.rotations[lane] = 0;

  int low = 0;
  while (find_blocks(dl, el, low, rows, &b)) {
    int high = 0;
    low = rows;
    for (int lane = 0; lane < count; ++lane) {
      if (LANE(b.l, lane) >= LANE(b.order, lane)) continue;
      low = min(low, (int)LANE(b.l, lane));
      high = max(high, (int)LANE(b.m, lane));
    }
    sweep(dl, el, c, s, low, high, &b);
    for (int lane = 0; lane < count; ++lane) {
      if (LANE(b.l, lane) >= LANE(b.order, lane)) continue;
      const int index = active[first + lane];
      if (record(&b, lane, segments[index], c, s, rotations, sweeps, &counts)) continue;
      failed[index] = 1;
      SET_LANE(b.order, lane, 0);  // takes no more part
    }
  }
  for (int lane = 0; lane < count; ++lane) {
    const int index = active[first + lane];
    const segment_t segment = segments[index];
    if (!chosen[index]) continue;
    sweep_counts[index] = counts.sweeps[lane];
    sort_values(dl, lane, scales[index], segment.order, segment.order_pitch,
                values + segment.vector, places + segment.vector);
  }
}
