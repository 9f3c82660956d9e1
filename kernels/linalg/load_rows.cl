// Loads ahead of a recurrence over the rows of a column (conjugate_gradients.cl, banded.cl). A
// work-item of a GPU would wait for memory at every row, and there are too few of them to fill the
// time: it has ROWS rows in registers before it goes over them. A CPU fetches ahead by itself.

#if VW == 1
#define ROWS 8
#else
#define ROWS 1
#endif

// `count` rows, a constant of at most ROWS, from entry `at` of a segment on, `to_next` entries
// apart. Entries count in 32 bits: the offsets of the rows serve all matrices, and addresses are no
// variables of their own.
INLINE void load_rows(vreal* rows, global const real* p, uint at, int to_next, const int count) {
#pragma unroll ROWS
  for (int k = 0; k < count; ++k) rows[k] = load(p + (uint)(at + k * to_next));
}
