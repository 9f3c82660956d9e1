// Steps of implicit QL on a tridiagonal T (Golub and Van Loan, 8.3.3) for entries of type ENTRY, a
// vector or a number; what tridiagonal_ql.cl and eigen_group.cl share. The rotations themselves are
// not among them: each form rounds them in the order that makes its next rotation wait least, and
// has bounds of its own for what is negligible. Before it is included,
//
//   tridiagonal_t                            is how T is held
//   negligible(const tridiagonal_t t, int i) says whether its off-diagonal i does not matter

// The next unreduced block l .. m of T, from row l on; l = n if there is none. It is known that l
// .. m has not fallen apart, but for its first row; m < l: nothing is known.
INLINE int2 next_block(const tridiagonal_t t, int l, int m, int n) {
  if (l < m && negligible(t, l)) ++l;
  while (l < n && l >= m) {  // a block of one is an eigenvalue
    if (l == m) ++l;
    m = l;
    while (m < n - 1 && !negligible(t, m)) ++m;
  }
  return (int2)(l, m);
}

// What the first rotation of a sweep over l .. m is to make zero with e_(m-1): d_m less the
// eigenvalue next to d_l of the first two rows.
INLINE ENTRY shifted_end(ENTRY d_l, ENTRY d_next, ENTRY e_l, ENTRY d_m) {
  const ENTRY shift = (d_next - d_l) / (2 * e_l);
  return d_m - d_l + e_l / (shift + copysign(sqrt(fma(shift, shift, (ENTRY)1)), shift));
}
