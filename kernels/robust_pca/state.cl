// The scalars of robust PCA, and what its steps report; prepended to its programs (robust_pca.cl,
// sweep.cl).

typedef struct {
  double mu;            // of the running iteration
  double mu_next;       // of the one after it
  double inverse_last;  // 1/mu of the iteration before, 0 in the first
  double mu_max;
  double lambda;
  double dual_scale;  // Y_0 = D * dual_scale
  double residual;    // |D - A - E|_F / |D|_F after the last iteration
  int iterations;
  int rank;
  int converged;
  int finished;  // converged or out of iterations: left alone from then on
  int order_ea;  // 1: E is updated before A
  int pure;      // 1: E has been zero so far, X has the singular vectors of D
  int keep;      // 1: the running iteration stores A, in the last one its A is the result
  int low_rank;  // 1: A = (XV) diag(f) V' takes clearly less work than A = XW
} state_t;       // mirrors moclean::opencl::SegmentState

// What an iteration reports of a block of rows.
typedef struct {
  double squares;  // |D - A - E|_F^2
  int sparse;      // whether E is not zero; order ae only
} report_t;        // mirrors moclean::opencl::BlockReport
