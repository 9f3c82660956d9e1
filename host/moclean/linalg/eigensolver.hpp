#pragma once

#include <variant>

#include "moclean/linalg/eigen.hpp"
#include "moclean/linalg/group_eigen.hpp"
#include "moclean/linalg/tuning.hpp"

namespace moclean {

/// The batched symmetric eigenproblem in the form a tuning asks for. Functions as in
/// SymmetricEigen, but for what vectors() leaves in `a`.
class Eigensolver {
 public:
  /// `negligible` as in SymmetricEigen, which alone heeds it.
  Eigensolver(const Device& device, const Tuning& tuning,
              double negligible = SymmetricEigen::rounding);

  void operator()(const Batch& batch, Buffer<double>& a, Buffer<double>& z, Buffer<double>& values);
  void values(const Batch& batch, const Buffer<std::int32_t>& chosen, Buffer<double>& a,
              Buffer<double>& values);
  void all_values(const Batch& batch, Buffer<double>& a, Buffer<double>& values);
  void vectors(const Batch& batch, const Buffer<std::int32_t>& wanted, Buffer<double>& a,
               Buffer<double>& z);
  void all_vectors(const Batch& batch, Buffer<double>& a, Buffer<double>& z);
  void check(const Batch& batch);

  /// Whether vectors() leaves the eigenvectors in the leading columns of `a`, too.
  bool leaves_columns() const { return std::holds_alternative<SymmetricEigen>(solver_); }

  /// Bytes of device memory a matrix of this order takes beside A, Z and its values.
  std::uint64_t memory_of(Index order) const;

 private:
  std::variant<SymmetricEigen, GroupEigen> solver_;
};

}  // namespace moclean
