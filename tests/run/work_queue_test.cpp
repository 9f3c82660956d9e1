#include "moclean/run/work_queue.hpp"

#include <memory>
#include <numeric>
#include <thread>
#include <vector>

#include <gmock/gmock.h>

#include "moclean/run/busy_clock.hpp"

namespace moclean {
namespace {

TEST(WorkQueue, GivesItemsInTheirOrderAndThenNothing) {
  WorkQueue<std::unique_ptr<int>> queue;
  for (const int item : {1, 2, 3}) queue.push(std::make_unique<int>(item));
  queue.close();

  for (const int item : {1, 2, 3}) EXPECT_EQ(**queue.pop(), item);

  EXPECT_FALSE(queue.pop().has_value());
}

TEST(WorkQueue, ClearedItemsAreGone) {
  WorkQueue<int> queue;
  queue.push(1);
  queue.clear();
  queue.push(2);
  queue.close();

  EXPECT_EQ(queue.pop(), 2);
  EXPECT_EQ(queue.pop(), std::nullopt);
}

TEST(WorkQueue, ThreadsShareTheItemsAndAllOfThemEnd) {
  constexpr int count = 10000;
  WorkQueue<int> queue;
  std::vector<int> seen(count, 0);
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < 3; ++t)
      threads.emplace_back([&] {
        while (const auto item = queue.pop()) ++seen[static_cast<std::size_t>(*item)];
      });

    for (int i = 0; i < count; ++i) queue.push(i);
    queue.close();
  }

  EXPECT_THAT(seen, ::testing::Each(1));
}

TEST(BusyClock, CountsWorkOfTwoThreadsAtOneTimeOnce) {
  using namespace std::chrono_literals;
  BusyClock clock;
  const auto begin = std::chrono::steady_clock::now();
  {
    const BusyClock::Work one(clock);
    const BusyClock::Work other(clock);
    std::this_thread::sleep_for(20ms);
    EXPECT_GE(one.seconds(), 0.02);
  }
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;

  std::this_thread::sleep_for(5ms);

  EXPECT_GE(clock.seconds(), 0.02);
  EXPECT_LE(clock.seconds(), wall.count());
}

}  // namespace
}  // namespace moclean
