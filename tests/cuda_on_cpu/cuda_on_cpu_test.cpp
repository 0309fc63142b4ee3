#include <gtest/gtest.h>

#include <cfenv>
#include <cstdlib>
#include <random>

#include "odd_kernels.hpp"

namespace hypotrack::test {
namespace {

TEST(CudaOnCpu, ThreadsOfABlockMeetAtBarriers) {
  for (const int threads : {1, 2, 64, 1024}) {
    EXPECT_EQ(sum_of_block(threads), threads * (threads + 1) / 2);
  }
}

TEST(CudaOnCpu, LanesOfAWarpGetOneAnothersNumbers) {
  const Exchanges exchanges = exchange_in_warp();
  for (int lane = 0; lane < 32; ++lane) {
    const auto i = static_cast<std::size_t>(lane);
    EXPECT_EQ(exchanges.of_five[i], 50);
    EXPECT_EQ(exchanges.of_neighbour[i], 10 * (lane ^ 1));
    EXPECT_EQ(exchanges.of_below[i], 10 * (lane < 2 ? lane : lane - 2));
    EXPECT_EQ(exchanges.multiples[i], 0x49249249u);
  }
}

TEST(CudaOnCpu, BlocksThatAreThereAtOnceWaitForOneAnother) {
  EXPECT_EQ(sum_over_blocks(2), 1);
  EXPECT_EQ(sum_over_blocks(7), 21);
}

TEST(CudaOnCpu, SumsAreRoundedAsAsked) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> number(-100.0f, 100.0f);
  for (int i = 0; i < 100; ++i) {
    const volatile float a = number(random), b = 1e-4f * number(random);
    const Roundings sums = round_sum(a, b);
    std::fesetround(FE_UPWARD);
    const volatile float up = a + b;
    std::fesetround(FE_DOWNWARD);
    const volatile float down = a + b;
    std::fesetround(FE_TONEAREST);
    EXPECT_EQ(sums.up, up) << a << " + " << b;
    EXPECT_EQ(sums.down, down) << a << " + " << b;
  }
}

TEST(CudaOnCpu, BytesArePermuted) {
  EXPECT_EQ(permute_bytes(0x44332211u, 0x88776655u, 0x7610u), 0x88772211u);
  EXPECT_EQ(permute_bytes(0x44332211u, 0x88776655u, 0x0347u), 0x11445588u);
}

TEST(CudaOnCpu, MemoryHasABound) {
  void* memory = nullptr;
  EXPECT_EQ(cudaMalloc(&memory, std::size_t{1} << 40), cudaErrorMemoryAllocation);
  EXPECT_EQ(cudaGetLastError(), cudaErrorMemoryAllocation);
  EXPECT_EQ(cudaGetLastError(), cudaSuccess);
}

/// Every error of a kernel stays, so that each needs a process of its own.
class BrokenKernels : public testing::Test {
 protected:
  void SetUp() override { GTEST_FLAG_SET(death_test_style, "threadsafe"); }

  [[noreturn]] static void run(Mistake mistake) {
    const bool failed = run_broken_kernel(mistake) == cudaErrorLaunchFailure;
    const bool stays = cudaDeviceSynchronize() == cudaErrorLaunchFailure;
    std::exit(failed && stays ? 3 : 0);
  }
};

TEST_F(BrokenKernels, TellWhereTheyTrap) {
  EXPECT_EXIT(run(Mistake::trap), testing::ExitedWithCode(3),
              R"(__trap\(\), block \(0, 0, 0\), thread \(7, 0, 0\))");
}
TEST_F(BrokenKernels, TellThatAWarpDiverged) {
  EXPECT_EXIT(run(Mistake::lanes_do_different_things), testing::ExitedWithCode(3),
              "do not do the same together");
}
TEST_F(BrokenKernels, TellThatThreadsWaitInVain) {
  EXPECT_EXIT(run(Mistake::wait_in_vain), testing::ExitedWithCode(3),
              R"(wait for others that do not come, block \(0, 0, 0\), thread)");
}

TEST_F(BrokenKernels, AreToldByTheThreadSanitizerThatABarrierIsMissing) {
#ifndef __SANITIZE_THREAD__
  GTEST_SKIP() << "this needs the preset cuda_on_cpu_tsan";
#endif
  const auto run = [](Barriers barriers) {
    sum_of_block(64, barriers);
    std::exit(0);  // or what the sanitizer makes of it
  };
  EXPECT_EXIT(run(Barriers::all), testing::ExitedWithCode(0), "");
  EXPECT_EXIT(run(Barriers::one_is_missing), testing::ExitedWithCode(66), "data race");
}

}  // namespace
}  // namespace hypotrack::test
