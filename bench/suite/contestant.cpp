#include "suite/contestant.hpp"

#include "moclean/backend/opencl_backend.hpp"

#include "peers/peer_backend.hpp"

namespace moclean::bench {
namespace {

Contestant device_solver(std::string name, const Device& device, const OpenClOptions& options) {
  return {std::move(name), std::make_unique<OpenClBackend>(device, options)};
}

Contestant peer(std::string name, int threads, const PeerBackend::MakeSolver& make_solver) {
  return {name, std::make_unique<PeerBackend>(name, threads, make_solver)};
}

}  // namespace

Contestant opencl(const Device& device) { return device_solver("opencl", device, {}); }

Contestant opencl_clblast(const Device& device) {
  return device_solver("opencl-clblast", device, {.products = ProductPath::clblast});
}

Contestant lapack(int threads) {
  return peer("lapack", threads, [] { return peers::make_lapack_solver(peers::LapackForm::best); });
}

Contestant lapack_textbook(int threads) {
  return peer("lapack-textbook", threads,
              [] { return peers::make_lapack_solver(peers::LapackForm::textbook); });
}

Contestant eigen(int threads) { return peer("eigen", threads, peers::make_eigen_solver); }

std::vector<Contestant> everyone(const Device& device, int threads) {
  std::vector<Contestant> all;
  all.push_back(opencl(device));
  all.push_back(lapack(threads));
  all.push_back(lapack_textbook(threads));
  all.push_back(eigen(threads));
  return all;
}

std::vector<Contestant> precision_modes(const Device& device) {
  std::vector<Contestant> modes;
  modes.push_back(device_solver("f64", device, {}));
  modes.push_back(device_solver("mixed", device, {.precision = Precision::mixed}));
  modes.back().method.tolerance = mixed_tolerance;
  modes.back().agreement = 1e-5;  // the bound of --verify
  return modes;
}

std::vector<Contestant> product_paths(const Device& device) {
  std::vector<Contestant> paths;
  paths.push_back(device_solver("own", device, {.products = ProductPath::own}));
  paths.push_back(device_solver("clblast", device, {.products = ProductPath::clblast}));
  return paths;
}

}  // namespace moclean::bench
