#include "moclean/run/memory_budget.hpp"

#include <atomic>
#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "moclean/core/error.hpp"

namespace moclean {
namespace {

using namespace std::chrono_literals;

// A thread that wants a share, and whether it has got it.
class Waiting {
 public:
  Waiting(MemoryBudget& budget, std::uint64_t bytes)
      : thread_([this, &budget, bytes](const std::stop_token& stop) {
          try {
            const MemoryShare share = budget.take(bytes, stop);
            got_ = true;
          } catch (const Cancelled&) {
            cancelled_ = true;
          }
        }) {}

  bool got_soon() const { return soon(got_); }
  bool cancelled_soon() {
    thread_.request_stop();
    return soon(cancelled_);
  }
  bool still_waits() const {
    std::this_thread::sleep_for(20ms);
    return !got_ && !cancelled_;
  }

 private:
  static bool soon(const std::atomic<bool>& event) {
    for (int i = 0; i < 5000 && !event; ++i) std::this_thread::sleep_for(1ms);
    return event;
  }

  std::atomic<bool> got_ = false, cancelled_ = false;
  std::jthread thread_;
};

TEST(MemoryBudget, GivesWhatFitsAtOnce) {
  MemoryBudget budget(10);

  const MemoryShare a = budget.take(6, {});
  const MemoryShare b = budget.take(4, {});

  EXPECT_EQ(a.bytes() + b.bytes(), budget.limit());
}

TEST(MemoryBudget, WaitsUntilEnoughIsGivenBack) {
  MemoryBudget budget(10);
  MemoryShare a = budget.take(6, {});
  MemoryShare b = budget.take(4, {});
  Waiting waiting(budget, 5);
  ASSERT_TRUE(waiting.still_waits());

  a.resize(2);
  EXPECT_TRUE(waiting.still_waits());
  b = {};

  EXPECT_TRUE(waiting.got_soon());
}

TEST(MemoryBudget, GivesAShareAboveTheLimitAlone) {
  MemoryBudget budget(10);
  MemoryShare small = budget.take(1, {});
  Waiting waiting(budget, 50);
  ASSERT_TRUE(waiting.still_waits());

  small = {};

  EXPECT_TRUE(waiting.got_soon());
}

TEST(MemoryBudget, AShareMayOutgrowTheLimitAndBlocksTheNext) {
  MemoryBudget budget(10);
  MemoryShare share = budget.take(5, {});
  share.resize(12);
  Waiting waiting(budget, 1);
  ASSERT_TRUE(waiting.still_waits());

  share.resize(9);

  EXPECT_TRUE(waiting.got_soon());
}

TEST(MemoryBudget, StopEndsTheWaiting) {
  MemoryBudget budget(10);
  const MemoryShare all = budget.take(10, {});
  Waiting waiting(budget, 1);
  ASSERT_TRUE(waiting.still_waits());

  EXPECT_TRUE(waiting.cancelled_soon());
}

TEST(MemoryBudget, AMovedShareIsGivenBackOnce) {
  MemoryBudget budget(10);
  {
    MemoryShare first = budget.take(10, {});
    MemoryShare second = std::move(first);
    MemoryShare third;
    third = std::move(second);
    EXPECT_EQ(third.bytes(), 10u);
  }

  const MemoryShare all = budget.take(10, {});

  EXPECT_TRUE(Waiting(budget, 1).cancelled_soon());
}

}  // namespace
}  // namespace moclean
