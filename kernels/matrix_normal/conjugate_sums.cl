// What the kernels of conjugate gradients share (conjugate_gradients.cl, search_direction.cl,
// search_direction_group.cl): sums over a segment, and what follows from them.

// Sum over the vectors of columns of a segment, in their order.
inline double sum_of_vectors(global const double* values, int b, const segment_t s) {
  const int vectors = s.pitch / VW;
  double sum = 0;
  for (int v = 0; v < vectors; ++v) sum += values[b * vectors + v];
  return sum;
}

inline int is_enough(double rz, global const double* bz, int b, const segment_t s,
                     double tolerance) {
  return !(rz > tolerance * tolerance * sum_of_vectors(bz, b, s));
}

// What a search for the next direction begins with.
typedef struct {
  real beta;
  int enough;  // 1: the segment is left as it is
} stage_t;

// `tolerance` negative: go on whatever r.z. `begins`: beta = 0.
inline stage_t stage_of(global const double* rz, global const double* rz_before,
                        global const double* bz, int b, const segment_t s, double tolerance,
                        int begins) {
  stage_t stage = {0, 0};
  if (tolerance < 0) return stage;
  const double squares = sum_of_vectors(rz, b, s);
  stage.enough = is_enough(squares, bz, b, s, tolerance);
  if (!begins) stage.beta = squares / sum_of_vectors(rz_before, b, s);
  return stage;
}
