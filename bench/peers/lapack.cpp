// The LAPACK peer. A packed row-major X [m x n] is the column-major X' [n x m] for BLAS, hence
//   G = X'X = (X')(X')'    A' = W X'    W = V diag(f) V'    f_k = 1 - tau/sigma_k for sigma_k > tau
#include "peers/lapack.hpp"

#include <stdexcept>
#include <string>

#include <cblas.h>

#include "peers/robust_pca.hpp"

namespace moclean::peers {
namespace {

using Numbers = std::vector<double>;

std::size_t area(int rows, int columns) {
  return static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
}

void require(int info, const char* routine) {
  if (info != 0) throw std::runtime_error(routine + (" gave info " + std::to_string(info)));
}

/// Eigenvectors of a symmetric matrix, all or those of the largest eigenvalues.
class Spectrum {
 public:
  void resize(int n) {
    n_ = n;
    // What dsyevd asks for, and blocks of 64 columns with their factor T for dormtr.
    work_.resize(1 + 6 * area(n, 1) + 2 * area(n, n) + 64 * area(n, 1) + 65 * 64);
    integer_work_.resize(3 + 5 * area(n, 1));
    values_.resize(area(n, 1));
    off_diagonal_.resize(area(n, 1));
    reflectors_.resize(area(n, 1));
    vectors_.resize(area(n, n));
  }

  /// dsyevd: G becomes its eigenvectors if `job` is "V"; the values increase.
  const Numbers& all(const char* job, double* G) {
    int info = 0;
    const int size = static_cast<int>(work_.size()),
              integers = static_cast<int>(integer_work_.size());
    dsyevd_(job, "L", &n_, G, &n_, values_.data(), work_.data(), &size, integer_work_.data(),
            &integers, &info);
    require(info, "dsyevd");
    return values_;
  }

  /// The steps of dsyevd, but only the vectors of eigenvalues above `bound` are transformed back.
  /// Returns the first of them; they are the last `rank` columns of an n x n matrix.
  const double* above(double bound, double* G, int& rank) {
    int info = 0;
    const int size = static_cast<int>(work_.size()),
              integers = static_cast<int>(integer_work_.size());
    dsytrd_("L", &n_, G, &n_, values_.data(), off_diagonal_.data(), reflectors_.data(),
            work_.data(), &size, &info);
    require(info, "dsytrd");
    dstedc_("I", &n_, values_.data(), off_diagonal_.data(), vectors_.data(), &n_, work_.data(),
            &size, integer_work_.data(), &integers, &info);
    require(info, "dstedc");
    rank = count_above(bound);
    double* kept = vectors_.data() + area(n_, n_ - rank);
    dormtr_("L", "L", "N", &n_, &rank, G, &n_, reflectors_.data(), kept, &n_, work_.data(), &size,
            &info);
    require(info, "dormtr");
    return kept;
  }

  int count_above(double bound) const {
    return static_cast<int>(values_.end() -
                            std::upper_bound(values_.begin(), values_.end(), bound));
  }
  const Numbers& values() const { return values_; }

 private:
  int n_ = 0;
  Numbers work_, values_, off_diagonal_, reflectors_, vectors_;
  std::vector<int> integer_work_;
};

class Lapack {
 public:
  explicit Lapack(LapackForm form) : form_(form) {}

  void resize(int m, int n) {
    m_ = m;
    n_ = n;
    spectrum_.resize(n);
    for (Numbers* matrix : {&G_, &W_, &scaled_}) matrix->resize(area(n, n));
    projected_.resize(area(m, n));
  }

  double norm_2(const double* X) {
    gram(X);
    return std::sqrt(spectrum_.all("N", G_.data()).back());
  }

  int shrink(const double* X, double tau, double* A) {
    gram(X);
    int rank = 0;
    const double* V = nullptr;
    if (form_ == LapackForm::best) {
      V = spectrum_.above(tau * tau, G_.data(), rank);
    } else {
      spectrum_.all("V", G_.data());
      rank = spectrum_.count_above(tau * tau);
      V = G_.data() + area(n_, n_ - rank);
    }
    scale(V, tau, rank);
    if (form_ == LapackForm::best && 2 * rank < n_) {
      multiply(CblasTrans, CblasNoTrans, rank, m_, n_, V, n_, X, n_, projected_.data(), rank);
      multiply(CblasNoTrans, CblasNoTrans, n_, m_, rank, scaled_.data(), n_, projected_.data(),
               std::max(rank, 1), A, n_);
    } else {
      multiply(CblasNoTrans, CblasTrans, n_, n_, rank, scaled_.data(), n_, V, n_, W_.data(), n_);
      multiply(CblasNoTrans, CblasNoTrans, n_, m_, n_, W_.data(), n_, X, n_, A, n_);
    }
    return rank;
  }

 private:
  void gram(const double* X) {
    cblas_dsyrk(CblasColMajor, CblasLower, CblasNoTrans, n_, m_, 1, X, n_, 0, G_.data(), n_);
  }

  // scaled = V diag(f), for the largest `rank` eigenvalues
  void scale(const double* V, double tau, int rank) {
    for (int k = 0; k < rank; ++k) {
      const double f = 1 - tau / std::sqrt(spectrum_.values()[area(n_ - rank + k, 1)]);
      for (std::size_t i = area(n_, k); i < area(n_, k + 1); ++i) scaled_[i] = f * V[i];
    }
  }

  // C = AB, C [rows x columns]
  static void multiply(CBLAS_TRANSPOSE a, CBLAS_TRANSPOSE b, int rows, int columns, int inner,
                       const double* A, int lda, const double* B, int ldb, double* C, int ldc) {
    cblas_dgemm(CblasColMajor, a, b, rows, columns, inner, 1, A, lda, B, ldb, 0, C,
                std::max(ldc, 1));
  }

  LapackForm form_;
  int m_ = 0, n_ = 0;
  Spectrum spectrum_;
  Numbers G_, W_, scaled_, projected_;
};

class LapackEigensolver final : public Eigensolver {
 public:
  void solve(int n, double* matrix, double* values) override {
    spectrum_.resize(n);
    const Numbers& found = spectrum_.all("V", matrix);
    std::copy(found.begin(), found.end(), values);
  }

 private:
  Spectrum spectrum_;
};

}  // namespace

std::unique_ptr<SegmentSolver> make_lapack_solver(LapackForm form) {
  openblas_set_num_threads(1);
  return std::make_unique<RobustPcaSolver<Lapack>>(Lapack(form));
}

std::unique_ptr<Eigensolver> make_lapack_eigensolver() {
  openblas_set_num_threads(1);
  return std::make_unique<LapackEigensolver>();
}

const char* openblas_description() { return openblas_get_config(); }
const char* openblas_kernels() { return openblas_get_corename(); }

}  // namespace moclean::peers
