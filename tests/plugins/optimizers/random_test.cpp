#include "hypotrack/plugin/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace hypotrack {
namespace {

using Block = std::array<std::uint32_t, 4>;

// Known answers of the authors' own implementation (Random123, kat_vectors, philox4x32 10).
static_assert(philox4x32({0, 0, 0, 0}, {0, 0}) ==
              Block{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8});

TEST(Random, PhiloxGivesThePublishedKnownAnswers) {
  EXPECT_EQ(philox4x32({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}),
            (Block{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Block{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(Random, UniformNumbersAreTheWordsOfTheBlock) {
  const auto u = uniform4(0x299f31d0a4093822, {0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344});
  EXPECT_EQ(u[0], (0xd16cfe09u + 0.5) / 4294967296.0);
  EXPECT_EQ(u[3], (0x24126ea1u + 0.5) / 4294967296.0);
}

TEST(Random, EveryPartOfTheIndexAndTheSeedMatters) {
  const double base = uniform4(1, {2, 3, 4, 5})[0];
  EXPECT_EQ(base, uniform4(1, {2, 3, 4, 5})[0]);
  EXPECT_NE(base, uniform4(2, {2, 3, 4, 5})[0]);
  EXPECT_NE(base, uniform4(1ull << 32, {2, 3, 4, 5})[0]);
  EXPECT_NE(base, uniform4(1, {0, 3, 4, 5})[0]);
  EXPECT_NE(base, uniform4(1, {2, 0, 4, 5})[0]);
  EXPECT_NE(base, uniform4(1, {2, 3, 0, 5})[0]);
  EXPECT_NE(base, uniform4(1, {2, 3, 4, 0})[0]);
}

TEST(Random, UniformNumbersFillTheOpenIntervalEvenly) {
  constexpr int kNumbers = 20000;
  double sum = 0;
  double squares = 0;
  for (int i = 0; i < kNumbers; ++i) {
    const auto u = uniform4(3, {static_cast<std::uint32_t>(i), 0, 0, 0});
    EXPECT_GT(u[0], 0);
    EXPECT_LT(u[0], 1);
    sum += u[0];
    squares += u[0] * u[0];
  }
  EXPECT_NEAR(sum / kNumbers, 0.5, 0.01);
  EXPECT_NEAR(squares / kNumbers, 1.0 / 3, 0.01);
}

TEST(Random, NormalNumbersHaveTheMomentsOfANormalDistribution) {
  constexpr int kNumbers = 20000;
  double sum = 0;
  double squares = 0;
  double fourth = 0;
  for (int i = 0; i < kNumbers; ++i) {
    const double z = normal(11, {0, static_cast<std::uint32_t>(i), 0, 0});
    ASSERT_TRUE(std::isfinite(z));
    sum += z;
    squares += z * z;
    fourth += z * z * z * z;
  }
  EXPECT_NEAR(sum / kNumbers, 0, 0.03);
  EXPECT_NEAR(squares / kNumbers, 1, 0.05);
  EXPECT_NEAR(fourth / kNumbers, 3, 0.3);
}

}  // namespace
}  // namespace hypotrack
