#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <thread>
#include <vector>

#include "moclean/core/matrix.hpp"

namespace moclean {

/// Calls work(0) .. work(count - 1), each once, on up to `jobs` threads, the calling one included.
/// After an exception no further call is started; the first one is rethrown when all have ended.
template <class Work>
void for_each_index(Index count, int jobs, const Work& work) {
  std::atomic<Index> next = 0;
  std::atomic<bool> failed = false;
  std::exception_ptr failure;
  const auto run = [&] {
    try {
      for (Index i = next++; i < count && !failed; i = next++) work(i);
    } catch (...) {
      if (!failed.exchange(true)) failure = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> others;
    for (Index t = 1; t < std::min<Index>(jobs, count); ++t) others.emplace_back(run);
    run();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace moclean
