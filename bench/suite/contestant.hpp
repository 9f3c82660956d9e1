#pragma once

#include <memory>
#include <string>
#include <vector>

#include "moclean/backend/backend.hpp"
#include "moclean/device/device.hpp"

namespace moclean::bench {

/// A solver under its name in the record, with what is asked of it.
struct Contestant {
  std::string name;
  std::unique_ptr<Backend> backend;
  RobustPca method = {};
  double agreement = 1e-8;  ///< largest relative difference of A from the reference
};

Contestant opencl(const Device& device);
Contestant opencl_clblast(const Device& device);

/// The peers with a number of threads: dsyevd in parts and the cheaper product, or as in a
/// textbook.
Contestant lapack(int threads);
Contestant lapack_textbook(int threads);
Contestant eigen(int threads);

/// Moclean and every peer.
std::vector<Contestant> everyone(const Device& device, int threads);

/// Every precision of the OpenCL backend, `f64` first.
std::vector<Contestant> precision_modes(const Device& device);

/// Both product paths of the OpenCL backend, `own` first.
std::vector<Contestant> product_paths(const Device& device);

}  // namespace moclean::bench
