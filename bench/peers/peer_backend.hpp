#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "moclean/backend/backend.hpp"

#include "peers/segment_solver.hpp"

namespace moclean::bench {

/// A peer as a Backend: a thread per solver, each takes the next segment when it is done with one.
/// Solvers and their workspaces are kept from call to call. Update order ae only.
class PeerBackend final : public Backend {
 public:
  using MakeSolver = std::function<std::unique_ptr<peers::SegmentSolver>()>;

  PeerBackend(std::string name, int threads, const MakeSolver& make_solver);

  std::string name() const override { return name_; }

  /// See Backend; the monitor is not asked. Throws ArgumentError for the order ea.
  Solution solve(const Problem& problem, const Method& method,
                 const Monitor& monitor = {}) override;

 private:
  std::string name_;
  std::vector<std::unique_ptr<peers::SegmentSolver>> solvers_;
};

}  // namespace moclean::bench
