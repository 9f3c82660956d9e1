#include "peers/rates.hpp"

#include <algorithm>
#include <cstring>

namespace moclean::peers {
namespace {

constexpr std::size_t vector_bytes = 64;
constexpr std::size_t chains = 12;  // more than latency times units, fewer than registers

template <class Real>
double multiply_add(std::size_t rounds) {
  using Vector [[gnu::vector_size(vector_bytes)]] = Real;
  constexpr std::size_t lanes = vector_bytes / sizeof(Real);
  Vector sums[chains] = {};
  for (Vector& sum : sums) asm volatile("" : "+m"(sum));  // each of unknown value, hence its own
  const Vector factor = Vector{} + Real(0.999), term = Vector{} + Real(0.001);
  for (std::size_t round = 0; round < rounds; ++round)
    for (Vector& sum : sums) sum = sum * factor + term;
  for (Vector& sum : sums) asm volatile("" : "+m"(sum));  // and used
  return 2.0 * static_cast<double>(rounds * chains * lanes);
}

}  // namespace

double multiply_add_double(std::size_t rounds) { return multiply_add<double>(rounds); }
double multiply_add_float(std::size_t rounds) { return multiply_add<float>(rounds); }

double copy(const double* from, double* to, std::size_t count) {
  std::memcpy(to, from, count * sizeof(double));
  asm volatile("" : : "r"(to) : "memory");
  return 2.0 * static_cast<double>(count * sizeof(double));
}

}  // namespace moclean::peers
