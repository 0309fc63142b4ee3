#include "cost/cuda/repeated_work.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <stdexcept>

#include "cost/cuda/device.hpp"
#include "device.hpp"

namespace hypotrack::cuda::internal {
namespace {

/// Counts how often memory of the GPU was cleared, and how often that was enqueued.
class RepeatedWorkTest : public testing::Test {
 protected:
  void SetUp() override {
    SKIP_WITHOUT_DEVICE();
    device_.emplace(0);
    device_->use();
    memory_.reserve(1);
    seen_.reserve(1);
  }
  Stream stream() const { return device_->stream(); }

  /// Enqueues work with an argument; returns whether it was a graph.
  bool enqueue(std::uint64_t argument) {
    const RepeatedWork::Arguments arguments{argument, 0, 0, 0};
    if (work_.launch(arguments, stream())) return true;
    work_.enqueue(arguments, stream(), [&] {
      ++enqueued_;
      check(cudaMemsetAsync(memory_.data(), static_cast<int>(argument), 1, native(stream())),
            "clearing memory");
    });
    return false;
  }
  int value() {
    check(
        cudaMemcpyAsync(seen_.data(), memory_.data(), 1, cudaMemcpyDeviceToHost, native(stream())),
        "reading memory");
    check(cudaStreamSynchronize(native(stream())), "waiting");
    return seen_.data()[0];
  }

  std::optional<Device> device_;
  RepeatedWork work_;
  DeviceBuffer<unsigned char> memory_;
  PinnedBuffer<unsigned char> seen_;
  int enqueued_ = 0;
};

TEST_F(RepeatedWorkTest, IsAGraphAfterAWhile) {
  int graphs = 0;
  for (int time = 0; time < 10; ++time) {
    for (const int argument : {3, 7}) {
      graphs += enqueue(static_cast<std::uint64_t>(argument));
      EXPECT_EQ(value(), argument);
    }
  }
  EXPECT_EQ(graphs, 14);  // three times each, it is enqueued and then captured
  EXPECT_EQ(enqueued_, 6);
}

TEST_F(RepeatedWorkTest, IsEnqueuedWhereItCannotBeCaptured) {
  int runs = 0;
  for (int time = 0; time < 10; ++time) {
    if (work_.launch({1, 0, 0, 0}, stream())) continue;
    work_.enqueue({1, 0, 0, 0}, stream(), [&] {
      if (cudaStreamSynchronize(native(stream())) != cudaSuccess)
        throw std::runtime_error("not while the stream is captured");
      ++runs;
    });
  }
  EXPECT_EQ(runs, 10);
}

TEST_F(RepeatedWorkTest, ForgetsWhatWasNotUsedForLong) {
  for (int time = 0; time < 4; ++time) enqueue(1);
  EXPECT_TRUE(enqueue(1));
  for (std::uint64_t other = 2; other < 100; ++other) enqueue(other);
  EXPECT_FALSE(enqueue(1));
  EXPECT_EQ(value(), 1);
}

}  // namespace
}  // namespace hypotrack::cuda::internal
