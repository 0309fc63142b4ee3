#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hypotrack/api/error.hpp"
#include "pso_cuda.hpp"

namespace hypotrack {
namespace {

TEST(PsoCudaAbsent, SaysWhatToWriteInstead) {
  EXPECT_THAT([] { PsoCuda({}, "scene.yaml:7:3"); },
              ::testing::ThrowsMessage<DeviceError>(
                  "scene.yaml:7:3: pso_cuda: this hypotrack was built without CUDA. Write `type: "
                  "pso`, the same search on the CPU, or build with -DHYPOTRACK_CUDA=ON"));
}

}  // namespace
}  // namespace hypotrack
