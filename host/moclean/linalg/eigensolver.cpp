#include "moclean/linalg/eigensolver.hpp"

namespace moclean {
namespace {

std::variant<SymmetricEigen, GroupEigen> make_solver(const Device& device, const Tuning& tuning,
                                                     double negligible) {
  if (tuning.eigen == KernelForm::gpu) return GroupEigen(device);
  return SymmetricEigen(device, tuning.panel, negligible);
}

}  // namespace

Eigensolver::Eigensolver(const Device& device, const Tuning& tuning, double negligible)
    : solver_(make_solver(device, tuning, negligible)) {}

void Eigensolver::operator()(const Batch& batch, Buffer<double>& a, Buffer<double>& z,
                             Buffer<double>& values) {
  std::visit([&](auto& solver) { solver(batch, a, z, values); }, solver_);
}

void Eigensolver::values(const Batch& batch, const Buffer<std::int32_t>& chosen, Buffer<double>& a,
                         Buffer<double>& values) {
  std::visit([&](auto& solver) { solver.values(batch, chosen, a, values); }, solver_);
}

void Eigensolver::all_values(const Batch& batch, Buffer<double>& a, Buffer<double>& values) {
  std::visit([&](auto& solver) { solver.all_values(batch, a, values); }, solver_);
}

void Eigensolver::vectors(const Batch& batch, const Buffer<std::int32_t>& wanted, Buffer<double>& a,
                          Buffer<double>& z) {
  if (auto* lanes = std::get_if<SymmetricEigen>(&solver_))
    lanes->vectors(batch, wanted, a, z);
  else
    std::get<GroupEigen>(solver_).vectors(batch, wanted, z);
}

void Eigensolver::all_vectors(const Batch& batch, Buffer<double>& a, Buffer<double>& z) {
  if (auto* lanes = std::get_if<SymmetricEigen>(&solver_))
    lanes->all_vectors(batch, a, z);
  else
    std::get<GroupEigen>(solver_).all_vectors(batch, z);
}

void Eigensolver::check(const Batch& batch) {
  std::visit([&](auto& solver) { solver.check(batch); }, solver_);
}

std::uint64_t Eigensolver::memory_of(Index order) const {
  return std::visit([&](const auto& solver) { return solver.memory_of(order); }, solver_);
}

}  // namespace moclean
