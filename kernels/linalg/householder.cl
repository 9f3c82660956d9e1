// Steps of Householder's reduction of A to tridiagonal form (Golub and Van Loan, 8.3.1) for entries
// of type ENTRY, a vector or a number; what tridiagonal.cl and tridiagonal_group.cl share:
//
//   A is worked on divided by a power of two
//   H = I - u u',  |u|^2 = 2,  with H x = (e, 0, ..)
//   HAH = A - v w' - w v'   for p = A u,  w = p - (p.u / 2) u,  v = u
//
// Sums are those of the form: over lanes of vectors, or over work-items.

// Below this, a sum of squares has lost digits to underflow; entries of 1e-145 next to entries of 1
// are nothing.
#define NEGLIGIBLE_SQUARES ((real)1e-290)

// A power of two and its inverse, in two factors: 2^-exponent alone overflows for subnormal
// entries.
typedef struct {
  real power, inverse, rest_of_inverse;
} scale_t;

// That which leaves entries below 2.
INLINE scale_t scale_of(real largest) {
  const int exponent = largest > 0 ? ilogb(largest) : 0;
  const scale_t scale = {ldexp((real)1, exponent), ldexp((real)1, -(exponent / 2)),
                         ldexp((real)1, -(exponent - exponent / 2))};
  return scale;
}

INLINE ENTRY scaled(ENTRY entry, const scale_t scale) {
  return entry * scale.inverse * scale.rest_of_inverse;
}

// u = `scale` (x - (e, 0, ..)); 0, and H = I, where the entries of x past its first are nothing.
typedef struct {
  real e, scale;
} reflector_t;

// rest: sum of the squares of the entries past the first.
INLINE reflector_t reflector_of(real first, real rest) {
  reflector_t h = {first, 0};
  if (rest < NEGLIGIBLE_SQUARES) return h;
  const real norm = sqrt(fma(first, first, rest));
  h.e = first > 0 ? -norm : norm;
  h.scale = 1 / sqrt(fma(-first, h.e, norm * norm));  // |u|^2 = 2 (norm^2 - first e)
  return h;
}

// Entry (i, j) of A - v w' - w v'.
INLINE ENTRY updated(ENTRY entry, ENTRY vi, ENTRY wi, ENTRY vj, ENTRY wj) {
  return fma(-wi, vj, fma(-vi, wj, entry));
}

// An entry of w.
INLINE ENTRY update_vector(ENTRY p, ENTRY u, real half_product) {
  return fma((ENTRY)(-half_product), u, p);
}
