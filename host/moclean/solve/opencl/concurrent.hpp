#pragma once

#include <functional>
#include <stop_token>

#include "moclean/core/matrix.hpp"

namespace moclean::opencl {

/// What a worker does with an item. `stop` is requested when the caller asked for it, or when
/// another worker has failed; the work then throws Cancelled soon.
using ItemWork = std::function<void(int worker, Index item, const std::stop_token& stop)>;

/// Calls `work` for the items 0 .. items - 1, each once and in this order, on `workers` threads of
/// which the calling one is worker 0. A worker takes the next item when it is done with one; no two
/// calls of the same worker overlap.
///
/// The first exception of any worker stops the others, and is thrown again when all have ended.
/// Throws Cancelled if `stop` was requested before the last item was begun.
void for_each_concurrently(int workers, Index items, const std::stop_token& stop,
                           const ItemWork& work);

}  // namespace moclean::opencl
