#include <gtest/gtest.h>

#include "device.hpp"
#include "hypotrack/gpu/runtime.cuh"
#include "kernels.hpp"

namespace hypotrack {
namespace {

TEST(Launch, CodeForOldGpusWaitsForTheKernelBefore) {
  SKIP_WITHOUT_DEVICE();
  const cuda::Device device(0);
  if (!cuda::overlaps_launches(device.limits())) GTEST_SKIP() << "this GPU overlaps no launches";
  const cuda::DeviceBuffer<int> values(2);
  cuda::check(cudaMemset(values.data(), 0, 2 * sizeof(int)), "clearing memory");
  cuda::check(cudaDeviceSynchronize(), "clearing memory");
  test::copy(values.data() + 1, values.data(), device.stream());  // loads the code
  cuda::check(cudaStreamSynchronize(cuda::native(device.stream())), "copying");
  test::write_late(values.data(), device.stream());
  test::copy(values.data(), values.data() + 1, device.stream());
  cuda::check(cudaStreamSynchronize(cuda::native(device.stream())), "copying");
  int copied = 0;
  cuda::check(cudaMemcpy(&copied, values.data() + 1, sizeof copied, cudaMemcpyDeviceToHost),
              "downloading");
  EXPECT_EQ(copied, 1);
}

}  // namespace
}  // namespace hypotrack
