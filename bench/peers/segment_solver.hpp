#pragma once

#include <memory>

/// The boundary of the shared library that holds the peers. They are compiled for the processor of
/// the build (-march=native), where Eigen aligns its objects differently; so only plain pointers
/// cross, and nothing of the library is visible outside but the functions below.
namespace moclean::peers {

/// One segment: row-major matrices [rows x columns], `pitch` doubles from row to row.
struct Segment {
  const double* data = nullptr;
  double* low_rank = nullptr;  ///< receives A
  double* sparse = nullptr;    ///< receives E
  int rows = 0;
  int columns = 0;
  int pitch = 0;
};

/// Parameters of moclean::RobustPca, lambda resolved; the order of updates is A, E, Y, mu.
struct Parameters {
  double lambda = 0;
  double rho = 0;
  double mu0_factor = 0;
  double mu_max_factor = 0;
  double tolerance = 0;
  int max_iterations = 0;
};

/// Means what moclean::SegmentOutcome means.
struct Outcome {
  int iterations = 0;
  int rank = 0;
  double residual = 0;
  bool converged = false;
};

/// Robust PCA of one segment after the other on the calling thread. Workspaces are kept, so that a
/// segment of the size of the last one allocates nothing.
class SegmentSolver {
 public:
  virtual ~SegmentSolver() = default;

  /// The data is finite.
  virtual Outcome solve(const Segment& segment, const Parameters& parameters) = 0;
};

/// The eigenproblem of one symmetric matrix after the other on the calling thread.
class Eigensolver {
 public:
  virtual ~Eigensolver() = default;

  /// `matrix` [n x n] becomes its eigenvectors, one per row; `values` [n], increasing.
  virtual void solve(int n, double* matrix, double* values) = 0;
};

/// What the LAPACK peer does in an iteration.
enum class LapackForm {
  textbook,  ///< dsyrk, dsyevd, W = V f(sigma) V', A = XW
  best       ///< dsyevd taken apart so that only the eigenvectors that survive the threshold are
             ///< transformed back, and A = (XV)(f(sigma) V') while that takes fewer operations
};

#define MOCLEAN_PEER __attribute__((visibility("default")))

MOCLEAN_PEER std::unique_ptr<SegmentSolver> make_lapack_solver(LapackForm form);
MOCLEAN_PEER std::unique_ptr<SegmentSolver> make_eigen_solver();
MOCLEAN_PEER std::unique_ptr<Eigensolver> make_lapack_eigensolver();
MOCLEAN_PEER std::unique_ptr<Eigensolver> make_eigen_eigensolver();

/// Version of OpenBLAS, its build options and the kernels it picked for this processor.
MOCLEAN_PEER const char* openblas_description();
MOCLEAN_PEER const char* openblas_kernels();

}  // namespace moclean::peers
