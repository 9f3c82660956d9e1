// Steps of a search for the next direction for entries of type ENTRY, a vector or a number; what
// search_direction.cl and search_direction_group.cl share, in the notation of
// conjugate_gradients.cl:
//
//   p = z + beta p,   C = Delta'P Delta p,   q = W o p + C R

// p of a segment, which is worked out wherever it is needed.
typedef struct {
  global const real *z, *p_before;  // of the first row
  global const real* precisions;    // P of the first row
  real beta;
} search_t;

INLINE search_t search_of(const segment_t s, global const real* z, global const real* p_before,
                          global const real* precisions, real beta) {
  const size_t begin = s.first_row * s.pitch;
  const search_t search = {z + begin, p_before + begin, precisions + s.first_row, beta};
  return search;
}

INLINE ENTRY direction_at(const search_t c, const segment_t s, int row, int column) {
  const size_t at = row * (size_t)s.pitch + column;
  return c.beta == 0 ? LOAD(c.z + at) : fma((ENTRY)c.beta, LOAD(c.p_before + at), LOAD(c.z + at));
}

INLINE ENTRY second_difference(ENTRY v0, ENTRY v1, ENTRY v2) { return v0 - 2 * v1 + v2; }

// P times the second difference of three rows from k on. k may lie before the first row, where
// there is none; P is 0 of the last two rows, which begin none.
INLINE ENTRY weighted_acceleration(const search_t c, int k, ENTRY p0, ENTRY p1, ENTRY p2) {
  return (k < 0 ? 0 : c.precisions[k]) * second_difference(p0, p1, p2);
}

// q, given the entry of C R; adds to the sum of p q.
INLINE ENTRY completed(ENTRY weight, ENTRY p, ENTRY product, ENTRY* sum) {
  const ENTRY q = fma(weight, p, product);
  *sum = fma(p, q, *sum);
  return q;
}
