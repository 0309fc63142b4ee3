#include "track/verify/ready_threads.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

namespace hypotrack::internal {
namespace {

/// Does works until each was done, with threads ready or not, and in two batches one after another.
void expect_all_done() {
  constexpr int kBatches = 500;
  for (int batch = 0; batch < kBatches; ++batch) {
    std::array<std::atomic<int>, 5> done{};
    run_together({[&] { ++done[0]; }, [&] { ++done[1]; }, [&] { ++done[2]; }});
    run_together({[&] { ++done[3]; }, [&] { ++done[4]; }});
    for (const auto& count : done) ASSERT_EQ(count, 1);
  }
}

TEST(ReadyThreads, DoEveryWorkOnce) {
  ReadyThreads threads(3);
  {
    const ReadyThreads::Awake awake(&threads);
    expect_all_done();
  }
  expect_all_done();  // they are asleep
  const ReadyThreads::Awake again(&threads);
  expect_all_done();
}

TEST(ReadyThreads, WorkAtTheSameTime) {
  constexpr auto kLongest = std::chrono::seconds(20);  // of a machine that is busy
  ReadyThreads threads(2);
  const ReadyThreads::Awake awake(&threads);
  std::atomic<int> met = 0;
  const auto meet = [&] {
    ++met;
    const auto begin = std::chrono::steady_clock::now();
    while (met < 3 && std::chrono::steady_clock::now() - begin < kLongest)
      std::this_thread::yield();
    EXPECT_EQ(met, 3);
  };
  run_together({meet, meet, meet});
}

TEST(ReadyThreads, AreNotNeeded) {
  const ReadyThreads::Awake none(nullptr);
  expect_all_done();
}

TEST(ReadyThreads, HelpOneThreadAtATime) {
  ReadyThreads threads(2);
  const ReadyThreads::Awake awake(&threads);
  std::atomic<int> inner = 0;
  const auto nested = [&] { run_together({[&] { ++inner; }, [&] { ++inner; }}); };
  run_together({nested, nested, nested});
  EXPECT_EQ(inner, 6);
}

TEST(ReadyThreads, PassAFailureOnAfterAllHaveEnded) {
  ReadyThreads threads(3);
  const ReadyThreads::Awake awake(&threads);
  constexpr int kTimes = 100;
  for (int i = 0; i < kTimes; ++i) {
    std::atomic<int> ended = 0;
    const auto fails = [&] {
      ++ended;
      throw std::runtime_error("on purpose");
    };
    const auto works = [&] { ++ended; };
    EXPECT_THROW(run_together({works, fails, works, fails}), std::runtime_error);
    EXPECT_EQ(ended, 4);
    run_together({works});
    EXPECT_EQ(ended, 5);
  }
}

TEST(ReadyThreads, EndAwakeOrAsleep) {
  constexpr int kTimes = 50;
  for (int i = 0; i < kTimes; ++i) {
    ReadyThreads never_used(2);
    ReadyThreads used(2);
    const ReadyThreads::Awake awake(&used);
  }
}

}  // namespace
}  // namespace hypotrack::internal
