#pragma once

#include <algorithm>
#include <cctype>
#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "moclean/denoise/chain.hpp"

#include "support/backends.hpp"
#include "support/limbs.hpp"

namespace moclean::test {

/// A chain of steps and what computes it.
struct Cleaner {
  std::string chain;
  BackendKind backend = BackendKind::reference;

  std::vector<Denoised> denoise(const std::vector<Recording>& takes) const {
    const Chain steps = parse_chain(chain);
    const auto computes = needs_backend(steps) ? make_backend(backend) : nullptr;
    return ChainDenoiser(steps, computes.get(), 1).denoise(takes);
  }
  Matrix motion(const Recording& take) const { return denoise({take}).at(0).motion; }
};

/// Every step with its defaults: on the reference and on the device, but a filter, which needs
/// neither, once.
inline std::vector<Cleaner> every_cleaner() {
  std::vector<Cleaner> all;
  for (const std::string_view name : step_names()) {
    all.push_back({std::string(name), BackendKind::reference});
    if (needs_backend(parse_chain(name)))
      all.push_back({std::string(name), BackendKind::opencl_cpu});
  }
  return all;
}

inline bool is_low_rank(const Cleaner& cleaner) {
  const Chain chain = parse_chain(cleaner.chain);
  return first_low_rank(chain) != nullptr;
}

/// A condition: that a cleaner is one of some steps.
inline auto one_of(std::vector<std::string> chains) {
  return [=](const Cleaner& cleaner) { return std::ranges::count(chains, cleaner.chain) > 0; };
}

inline std::vector<Cleaner> cleaners_that(const std::function<bool(const Cleaner&)>& match) {
  std::vector<Cleaner> some = every_cleaner();
  std::erase_if(some, std::not_fn(match));
  return some;
}

/// For the names of test cases.
inline std::string name_of(const Cleaner& cleaner) {
  std::string name = needs_backend(parse_chain(cleaner.chain)) ? to_string(cleaner.backend) : "";
  for (const char c : cleaner.chain)
    if (std::isalnum(static_cast<unsigned char>(c))) name += c;
  return name;
}

inline std::ostream& operator<<(std::ostream& out, const Cleaner& cleaner) {
  return out << cleaner.chain << " on " << to_string(cleaner.backend);
}

/// Samples under the names a table without heads gets, at 120 Hz.
inline Recording take_of(Matrix samples) {
  Recording take;
  take.columns = default_column_names(samples.cols());
  take.samples = std::move(samples);
  take.frame_rate = 120;
  return take;
}

/// A body of rigid bones with noise everywhere and a few gross errors.
inline Recording noisy_limbs(Index frames = 120, Index joint_count = 6) {
  Matrix samples = swinging_limbs(frames, joint_count);
  Random random(5);
  for (Index i = 0; i < samples.size(); ++i) samples.data()[i] += 0.02 * random.normal();
  for (Index k = 0; k < 8; ++k) samples((7 + 11 * k) % frames, (5 * k + 1) % samples.cols()) += 2;
  return take_of(std::move(samples));
}

}  // namespace moclean::test
