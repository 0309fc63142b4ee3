#include "cost/cuda/memory/block_pool.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <random>
#include <thread>
#include <vector>

#include "pool_on_host.hpp"

namespace hypotrack::cuda {
namespace {

TEST(BlockPool, HandsOutWhatWasGivenBack) {
  test::PoolOnHost host(1 << 20);
  void* first = host.pool.take(100'000);
  host.pool.give_back(first, 100'000);
  EXPECT_EQ(host.pool.take(100'000), first);
  EXPECT_EQ(host.allocations(), 1);
  EXPECT_NE(host.pool.take(100'000), first);
  EXPECT_EQ(host.allocations(), 2);
}

TEST(BlockPool, HandsOutEveryBlockGivenBackOnce) {
  test::PoolOnHost host(1 << 20);
  std::vector<void*> taken(8), again(8);
  for (void*& block : taken) block = host.pool.take(70'000);
  for (void* block : taken) host.pool.give_back(block, 70'000);
  for (void*& block : again) block = host.pool.take(70'000);
  std::sort(taken.begin(), taken.end());
  std::sort(again.begin(), again.end());
  EXPECT_EQ(again, taken);
  EXPECT_EQ(host.allocations(), 8);
}

TEST(BlockPool, AllocatesSeveralBlocksAtOnceWithinItsBound) {
  test::PoolOnHost host(9 << 16, 4 << 16);
  std::vector<void*> taken(9);
  for (void*& block : taken) {
    block = host.pool.take(1 << 16);
    ASSERT_TRUE(block);
    std::memset(block, 1, 1 << 16);
  }
  EXPECT_EQ(host.pool.take(1 << 16), nullptr);
  EXPECT_EQ(host.allocations(), 3);  // of four, four and one
  std::sort(taken.begin(), taken.end());
  for (std::size_t i = 1; i < taken.size(); ++i)
    EXPECT_GE(static_cast<std::byte*>(taken[i]) - static_cast<std::byte*>(taken[i - 1]), 1 << 16);
}

TEST(BlockPool, BlocksHoldWhatWasAskedForAndAQuarterMoreAtMost) {
  test::PoolOnHost host(std::size_t{1} << 31);
  for (std::size_t bytes = 64; bytes < (std::size_t{1} << 28); bytes += bytes / 7 + 1) {
    host.pool.take(bytes);
    EXPECT_GE(host.last_bytes(), bytes);
    EXPECT_LE(host.last_bytes(), bytes + bytes / 4) << bytes;
  }
}

TEST(BlockPool, GivesABlockToSizesThatItHoldsOnly) {
  test::PoolOnHost host(1 << 20);
  host.pool.give_back(host.pool.take(1 << 16), 1 << 16);
  host.pool.take((1 << 16) + 1);
  EXPECT_EQ(host.allocations(), 2);
  EXPECT_GT(host.last_bytes(), std::size_t{1} << 16);
}

TEST(BlockPool, HasNoMoreThanItsBound) {
  test::PoolOnHost host(4 << 16);
  std::vector<void*> taken(4);
  for (void*& block : taken) block = host.pool.take(1 << 16);
  EXPECT_NE(taken.back(), nullptr);
  EXPECT_EQ(host.pool.take(1 << 16), nullptr);
  EXPECT_EQ(host.pool.take(64), nullptr);
  EXPECT_EQ(host.pool.take(SIZE_MAX), nullptr);
  host.pool.give_back(taken.back(), 1 << 16);
  EXPECT_EQ(host.pool.take(1 << 16), taken.back());
}

TEST(BlockPool, AsksNoMoreOnceThereIsNoMemory) {
  int asked = 0;
  std::vector<char> only(1 << 16);
  BlockPool pool([&](std::size_t) -> void* { return ++asked == 1 ? only.data() : nullptr; },
                 1 << 30);
  EXPECT_EQ(pool.take(1 << 16), only.data());
  EXPECT_EQ(pool.take(1 << 16), nullptr);
  EXPECT_EQ(pool.take(1 << 16), nullptr);
  EXPECT_EQ(asked, 2);
  pool.give_back(only.data(), 1 << 16);
  EXPECT_EQ(pool.take(1 << 16), only.data());
}

/// Holds up to eight blocks at a time, full of a number of its own. How many were damaged.
int damaged_blocks(BlockPool& pool, unsigned thread) {
  struct Held {
    unsigned char* block;
    std::size_t bytes;
  };
  std::mt19937 random(thread);
  std::array<Held, 8> held{};
  int damaged = 0;
  for (int step = 0; step < 60'000; ++step) {
    auto& [block, bytes] = held[random() % held.size()];
    if (block) {
      const bool whole =
          std::all_of(block, block + bytes, [&](int at) { return at == static_cast<int>(thread); });
      damaged += whole ? 0 : 1;
      pool.give_back(block, bytes);
    }
    bytes = 64 + random() % 100;
    block = static_cast<unsigned char*>(pool.take(bytes));
    if (block) std::memset(block, static_cast<int>(thread), bytes);
  }
  for (const auto& [block, bytes] : held) {
    if (block) pool.give_back(block, bytes);
  }
  return damaged;
}

TEST(BlockPool, ABlockIsOneThreadsAtATime) {
  test::PoolOnHost host(5000);  // less than the threads want
  std::atomic<int> damaged = 0;
  std::vector<std::thread> threads;
  for (unsigned i = 1; i <= 8; ++i) {
    threads.emplace_back([&, i] { damaged += damaged_blocks(host.pool, i); });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(damaged, 0);
  EXPECT_LE(host.total_bytes(), 5000U);
  EXPECT_GT(host.allocations(), 8);
}

}  // namespace
}  // namespace hypotrack::cuda
