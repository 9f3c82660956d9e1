// What the norms of a segment take of an entry of type ENTRY, a vector or a number; what norms.cl
// and norms_group.cl share.

typedef struct {
  ENTRY squares, largest;  // sum of squares, largest magnitude
} norms_t;

INLINE void add_entry(norms_t* norms, ENTRY entry) {
  norms->squares = fma(entry, entry, norms->squares);
  norms->largest = fmax(norms->largest, fabs(entry));
}
