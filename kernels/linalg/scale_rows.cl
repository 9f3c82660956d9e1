// Scaled eigenvectors for W = (diag(f) Z)' Z as one plain matrix product: row k of the result is
// f_k z_k.
//
// Launch: (largest order, active segments), one work-item per row.

kernel void scale_rows(global const segment_t* segments,  // [segments]
                       global const int* active,          // [active segments]
                       global const real* z,              // eigenvectors in rows, order x order
                       global const real* f,              // weights, `order` per segment
                       global real* scaled) {             // order x order matrices
  const segment_t s = segments[active[get_global_id(1)]];
  const int k = get_global_id(0);
  if (k >= s.order) return;
  const size_t row = s.square + k * (size_t)s.order_pitch;
  const real weight = f[s.vector + k];
  for (int j = 0; j < s.order_pitch; j += VW) store(scaled + row + j, weight * load(z + row + j));
}
