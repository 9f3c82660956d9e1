// The leading eigenvectors of A = Q T Q', T = S diag(values) S', for many matrices: the columns of
// QS that belong to the largest values, from the reflectors of tridiagonal.cl and the rotations of
// tridiagonal_ql.cl.
//
// S = J_1' J_2' .. J_N' with the rotations in the order in which QL did them. They are applied from
// the last to the first to unit vectors, so that the work is proportional to the number of vectors
// wanted; then the reflectors H_k = I - u_k u_k', also from the last to the first.
// A work-item makes PANEL * VW vectors, the columns of U [order x PANEL VW], which fits the nearest
// cache at usual orders. T is turned around, so its row i is row order - 1 - i of U.
// Launch: (panels of the largest order, active segments).

#ifndef PANEL
#error "PANEL is not defined: vectors of VW columns that a work-item transforms"
#endif

// Unit vectors at the places of the eigenvalues first .., zero past the last one.
inline void start_vectors(global real* u, global const int* places, int first, int wanted, int n,
                          int pitch, const int width) {
  for (int i = 0; i < n; ++i)
    for (int v = 0; v < width; ++v) store(u + i * (size_t)pitch + v * VW, 0);
  for (int j = 0; j < min(width * VW, wanted - first); ++j)
    u[(n - 1 - places[first + j]) * (size_t)pitch + j] = 1;
}

// Rows as the rotations count them, from the end of U.
inline global real* row_of(global real* u, int i, int n, int pitch) {
  return u + (n - 1 - i) * (size_t)pitch;
}

// (a, b) <- (c a + s b, c b - s a), in three steps instead of four products, p = s / (1 + c):
//   a += p b,  b -= s a,  a += p b
#define ROTATE(p, s, a, b) \
  {                        \
    a = fma(p, b, a);      \
    b = fma(-(s), a, b);   \
    a = fma(p, b, a);      \
  }

// Rows l .. m: one sweep, backwards; rotation i acts on rows i and i + 1.
INLINE void undo_sweep(global real* u, global const real* rotations, int l, int m, int n, int pitch,
                       const int width) {
  vreal carried[PANEL];
#pragma unroll
  for (int v = 0; v < width; ++v) carried[v] = load(row_of(u, l, n, pitch) + v * VW);
  for (int i = l; i < m; ++i) {
    const vreal p = rotations[2 * (m - 1 - i)], s = rotations[2 * (m - 1 - i) + 1];
    global real* row = row_of(u, i, n, pitch);
#pragma unroll
    for (int v = 0; v < width; ++v) {
      vreal next = load(row - pitch + v * VW);
      ROTATE(p, s, carried[v], next);
      store(row + v * VW, carried[v]);
      carried[v] = next;
    }
  }
#pragma unroll
  for (int v = 0; v < width; ++v) store(row_of(u, m, n, pitch) + v * VW, carried[v]);
}

// Two sweeps in one pass: the one that QL did later, on rows l2 .. m, and the earlier one, on rows
// l1 .. m, l1 <= l2 < m, which follows a row behind on rows that are still in registers.
INLINE void undo_two_sweeps(global real* u, global const real* later, int l2,
                            global const real* earlier, int l1, int m, int n, int pitch,
                            const int width) {
  vreal ahead[PANEL], behind[PANEL];
  int i = l2;
  if (l1 < l2) {
    undo_sweep(u, earlier + 2 * (m - l2 + 1), l1, l2 - 1, n, pitch, width);
#pragma unroll
    for (int v = 0; v < width; ++v) {
      behind[v] = load(row_of(u, l2 - 1, n, pitch) + v * VW);
      ahead[v] = load(row_of(u, l2, n, pitch) + v * VW);
    }
  } else {
#pragma unroll
    for (int v = 0; v < width; ++v) {
      behind[v] = load(row_of(u, l2, n, pitch) + v * VW);
      ahead[v] = load(row_of(u, l2 + 1, n, pitch) + v * VW);
      ROTATE(later[2 * (m - 1 - l2)], later[2 * (m - 1 - l2) + 1], behind[v], ahead[v]);
    }
    ++i;
  }
  for (; i < m; ++i) {
    const vreal p2 = later[2 * (m - 1 - i)], s2 = later[2 * (m - 1 - i) + 1];
    const vreal p1 = earlier[2 * (m - i)], s1 = earlier[2 * (m - i) + 1];
    global real* row = row_of(u, i, n, pitch);
#pragma unroll
    for (int v = 0; v < width; ++v) {
      vreal next = load(row - pitch + v * VW);
      ROTATE(p2, s2, ahead[v], next);
      ROTATE(p1, s1, behind[v], ahead[v]);
      store(row + pitch + v * VW, behind[v]);
      behind[v] = ahead[v];
      ahead[v] = next;
    }
  }
  const vreal p = earlier[0], s = earlier[1];
#pragma unroll
  for (int v = 0; v < width; ++v) {
    ROTATE(p, s, behind[v], ahead[v]);
    store(row_of(u, m - 1, n, pitch) + v * VW, behind[v]);
    store(row_of(u, m, n, pitch) + v * VW, ahead[v]);
  }
}

// U <- S U: the rotations from the last to the first. Sweeps that touch rows `low` .. `high` only
// while U is zero there are left out.
INLINE void undo_rotations(global real* u, global const real* rotations, global const int* sweeps,
                           int sweep_count, int low, int high, int n, int pitch, const int width) {
  int before = 0;  // rotations of the sweeps 0 .. i
  for (int i = 0; i < sweep_count; ++i) before += sweeps[2 * i + 1] - sweeps[2 * i];
  for (int i = sweep_count - 1; i >= 0; --i) {
    const int l = sweeps[2 * i], m = sweeps[2 * i + 1];
    before -= m - l;
    if (l > high || m < low) continue;
    low = min(low, l);
    high = max(high, m);
    global const real* later = rotations + 2 * (size_t)before;
    if (i > 0 && sweeps[2 * i - 1] == m && sweeps[2 * i - 2] <= l) {
      --i;
      const int l1 = sweeps[2 * i];
      before -= m - l1;
      low = min(low, l1);
      undo_two_sweeps(u, later, l, rotations + 2 * (size_t)before, l1, m, n, pitch, width);
    } else {
      undo_sweep(u, later, l, m, n, pitch, width);
    }
  }
}

// U <- H_k H_k+1 U, which touches the rows past k only. Two at a time, so that a row is read and
// written half as often:
//   b = u_k+1' U,  a = u_k' U - (u_k' u_k+1) b,   U - u_k a - u_k+1 b
INLINE void reflect(global real* u, global const real* first, global const real* second, int k,
                    int n, int pitch, const int width) {
  vreal a[PANEL], b[PANEL];
  real overlap = 0;
#pragma unroll
  for (int v = 0; v < width; ++v) a[v] = b[v] = 0;
  for (int i = k + 1; i < n; ++i) {
    const real f = first[i], g = second[i];
    overlap = fma(f, g, overlap);
#pragma unroll
    for (int v = 0; v < width; ++v) {
      const vreal row = load(u + i * (size_t)pitch + v * VW);
      a[v] = fma((vreal)f, row, a[v]);
      b[v] = fma((vreal)g, row, b[v]);
    }
  }
#pragma unroll
  for (int v = 0; v < width; ++v) a[v] = fma((vreal)-overlap, b[v], a[v]);
  for (int i = k + 1; i < n; ++i) {
    const real f = first[i], g = second[i];
#pragma unroll
    for (int v = 0; v < width; ++v) {
      global real* entry = u + i * (size_t)pitch + v * VW;
      store(entry, fma((vreal)-g, b[v], fma((vreal)-f, a[v], load(entry))));
    }
  }
}

// Rows first .. of Z from the columns of U.
inline void transpose(global const real* u, global real* z, int first, int last, int n, int pitch) {
  for (int j = first; j < last; ++j) {
    for (int i = 0; i < n; ++i) z[j * (size_t)pitch + i] = u[i * (size_t)pitch + j - first];
    for (int i = n; i < pitch; ++i) z[j * (size_t)pitch + i] = 0;
  }
}

// The vectors of `width` * VW eigenvalues from `first` on.
INLINE void transform(const segment_t s, global real* u, global const real* reflectors,
                      global const real* rotations, global const int* sweeps, int sweep_count,
                      global const int* places, global real* z, int first, int wanted,
                      const int width) {
  const int n = s.order, pitch = s.order_pitch;
  int low = n, high = 0;
  for (int j = first; j < min(first + width * VW, wanted); ++j) {
    low = min(low, places[j]);
    high = max(high, places[j]);
  }
  start_vectors(u, places, first, wanted, n, pitch, width);
  undo_rotations(u, rotations, sweeps, sweep_count, low, high, n, pitch, width);
  // H_n-2 is the identity (no entry is left to be cleared), so it can be left out of the pairs.
  for (int k = n - 2 - (n % 2 == 0); k >= 1; k -= 2)
    reflect(u, reflectors + (k - 1) * (size_t)pitch, reflectors + k * (size_t)pitch, k - 1, n,
            pitch, width);
  transpose(u, z, first, min(first + width * VW, wanted), n, pitch);
}

kernel void eigenvectors(global const segment_t* segments,  // [segments]
                         global const int* active,          // [active segments]
                         global const int* wanted,          // [segments]: leading vectors wanted
                         global const real* reflectors,     // u_k in row k
                         global const real* rotations,      // (p, s), ROTATIONS_PER_ENTRY per entry
                         global const int* sweeps,          // first, m; SWEEPS_PER_ROW per row
                         global const int* sweep_counts,    // [segments]
                         global const int* places,          // `order` per segment
                         global real* panels,               // order x order matrices, scratch
                         global real* z) {  // the vectors in its leading rows; others are kept
  const int index = active[get_global_id(1)];
  const segment_t s = segments[index];
  const int last = min(wanted[index], s.order);
  // As few panels as possible, of equal size as far as may be.
  const int vectors = (last + VW - 1) / VW, panel_count = (vectors + PANEL - 1) / PANEL;
  const int panel = get_global_id(0);
  if (panel >= panel_count) return;
  const int end = vectors * (panel + 1) / panel_count;
  // Loops over the vectors of a panel unroll into registers only if their number is a constant (at
  // most PANEL, in branches that are never taken, too). Three are taken as two and one: every
  // width is a quarter of what there is to compile.
#define TRANSFORM(width)                                                                    \
  transform(s, panels + s.square + v * VW, reflectors + s.square,                           \
            rotations + 2 * (size_t)ROTATIONS_PER_ENTRY * s.square,                         \
            sweeps + 2 * SWEEPS_PER_ROW * s.vector, sweep_counts[index], places + s.vector, \
            z + s.square, v * VW, last, width);                                             \
  v += width
  for (int v = vectors * panel / panel_count; v < end;) {
    if (end - v >= PANEL) {
      TRANSFORM(PANEL);
    } else if (PANEL > 4 && end - v >= 4) {
      TRANSFORM(min(4, PANEL));
    } else if (PANEL > 2 && end - v >= 2) {
      TRANSFORM(min(2, PANEL));
    } else {
      TRANSFORM(1);
    }
  }
}
