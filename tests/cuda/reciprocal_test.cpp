#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "device.hpp"
#include "reciprocal_kernel.hpp"

namespace hypotrack::test {
namespace {

TEST(ExactReciprocal, IsThatOfTheCpuForEveryMantissa) {
  SKIP_WITHOUT_DEVICE();
  constexpr std::uint32_t kMantissas = 1u << 23;
  for (const float power : {1.0f, -1.0f, 0x1p-66f, 0x1p-20f, 0.5f, 0x1p40f}) {
    const auto first = std::bit_cast<std::uint32_t>(power);
    const std::vector<float> found = exact_reciprocals(first, kMantissas);
    std::uint32_t wrong = 0;
    for (std::uint32_t i = 0; i < kMantissas; ++i) {
      if (found[i] != 1.0f / std::bit_cast<float>(first + i)) ++wrong;
    }
    EXPECT_EQ(wrong, 0u) << power;
  }
}

}  // namespace
}  // namespace hypotrack::test
