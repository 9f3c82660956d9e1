#pragma once

#include "moclean/methods/robust_pca/robust_pca.hpp"

namespace moclean::opencl {

/// What is the same for all iterations of a batch.
struct IterationSetting {
  bool mixed = false;  ///< stacked matrices in single precision; always fused
  /// Between two eigenproblems there is one sweep over the rows, not one matrix after the other:
  /// not with CLBlast's products, in the GPU form, or where samples are missing.
  bool fused = false;
  bool columns = false;  ///< the eigensolver leaves V, which a sweep at low rank needs
};

/// What an iteration of robust PCA does, for all segments of a batch alike; decided before it
/// begins.
struct Iteration {
  /// Where the matrix of the eigenproblem is from. Wide segments have their X as a whole in any
  /// case.
  enum class Gram {
    last_sweep,     ///< X'X by the sweep of the iteration before; D'D in the first
    whole_matrix,   ///< X'X of X as a whole
    single_floats,  ///< X'X of X in single precision, formed by rows
    rotated         ///< B'B, a graded matrix: X as a whole in the vectors of the iteration before
  };
  enum class Vectors {
    thresholded,  ///< those of singular values past the threshold
    all           ///< the basis of the next iteration, whose Gram matrix is `rotated`
  };
  enum class Update {
    sweep,            ///< A, E and Y+ in one sweep over the rows
    sweep_with_gram,  ///< and X+'X+ in the same
    whole_matrices    ///< A as a whole, then E and Y+
  };

  int number = 0;
  double tau = 0;  ///< (1/mu) / |D|_2, the same for all segments
  Gram gram = Gram::whole_matrix;
  Vectors vectors = Vectors::thresholded;
  Update update = Update::whole_matrices;
  bool low_rank = false;  ///< permits A = (XV) diag(f) V'

  bool graded() const { return gram == Gram::rotated; }
  bool before_graded() const { return vectors == Vectors::all; }
  bool whole_x() const { return gram == Gram::whole_matrix || graded(); }
  bool swept() const { return update != Update::whole_matrices; }

  bool operator==(const Iteration&) const = default;
};

/// The first iteration: mu = mu0_factor / |D|_2.
Iteration first_iteration(const RobustPca& method, const IterationSetting& setting);

/// The one after `now`: mu = min(rho mu, mu_max).
Iteration next_iteration(const Iteration& now, const RobustPca& method,
                         const IterationSetting& setting);

/// How much the residual can fall in one iteration. It falls by about rho and never was seen to
/// fall by four with the default; nothing but time is lost if it does.
double steepest_fall(const RobustPca& method);

/// Iterations from `now` on, at least one, after which it is worth to look which segments have
/// finished: in all but the last none can, going by the largest fall of `residual`, the least of
/// those last read.
int iterations_until_look(const Iteration& now, double residual, const RobustPca& method);

}  // namespace moclean::opencl
