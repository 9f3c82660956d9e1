#include "moclean/solve/opencl/concurrent.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gmock/gmock.h>

#include "moclean/core/error.hpp"

namespace moclean::opencl {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;

// Waits until the others have done their part; fails instead of hanging for ever.
template <class Condition>
bool comes_true(const Condition& condition) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!condition() && std::chrono::steady_clock::now() < end) std::this_thread::yield();
  return condition();
}

TEST(Concurrent, EveryItemIsWorkedOnOnce) {
  for (const int workers : {1, 2, 3, 7}) {
    std::vector<std::atomic<int>> times(25);

    for_each_concurrently(workers, 25, {}, [&](int worker, Index item, const std::stop_token&) {
      EXPECT_GE(worker, 0);
      EXPECT_LT(worker, workers);
      ++times[static_cast<std::size_t>(item)];
    });

    EXPECT_TRUE(std::ranges::all_of(times, [](int count) { return count == 1; })) << workers;
  }
}

TEST(Concurrent, OneWorkerIsTheCallingThreadAndKeepsTheOrder) {
  std::vector<Index> items;
  std::vector<std::thread::id> threads;

  for_each_concurrently(1, 4, {}, [&](int, Index item, const std::stop_token&) {
    items.push_back(item);
    threads.push_back(std::this_thread::get_id());
  });

  EXPECT_THAT(items, ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(threads, Each(std::this_thread::get_id()));
}

TEST(Concurrent, WorkersAreBusyAtTheSameTime) {
  std::atomic<int> busy = 0;

  for_each_concurrently(3, 3, {}, [&](int, Index, const std::stop_token&) {
    ++busy;
    EXPECT_TRUE(comes_true([&] { return busy == 3; }));
  });

  EXPECT_EQ(busy, 3);
}

TEST(Concurrent, FailureStopsTheOthersAndIsThrownOnce) {
  std::atomic<int> begun = 0, stopped = 0;
  const auto work = [&](int, Index item, const std::stop_token& stop) {
    ++begun;
    if (item == 1) {
      EXPECT_TRUE(comes_true([&] { return begun == 3; }));
      throw std::length_error("item 1");
    }
    EXPECT_TRUE(comes_true([&] { return stop.stop_requested(); }));
    ++stopped;
    throw Cancelled();
  };

  EXPECT_THROW(for_each_concurrently(3, 100, {}, work), std::length_error);

  EXPECT_EQ(begun, 3) << "nothing is begun after a failure";
  EXPECT_EQ(stopped, 2);
}

TEST(Concurrent, StopReachesWorkThatHasBegunAndEndsTheRest) {
  std::stop_source source;
  std::atomic<int> begun = 0;
  const auto work = [&](int, Index, const std::stop_token& stop) {
    if (++begun == 2) source.request_stop();
    EXPECT_TRUE(comes_true([&] { return stop.stop_requested(); }));
  };

  EXPECT_THROW(for_each_concurrently(2, 100, source.get_token(), work), Cancelled);

  EXPECT_EQ(begun, 2);
}

TEST(Concurrent, StopBeforeTheBeginBeginsNothing) {
  std::stop_source source;
  source.request_stop();
  bool begun = false;

  EXPECT_THROW(for_each_concurrently(1, 2, source.get_token(),
                                     [&](int, Index, const std::stop_token&) { begun = true; }),
               Cancelled);

  EXPECT_FALSE(begun);
}

}  // namespace
}  // namespace moclean::opencl
