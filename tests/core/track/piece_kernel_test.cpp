#include "track/rig/piece_kernel.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <opencv2/core.hpp>
#include <vector>

namespace hypotrack {
namespace {

using ::testing::Each;
using ::testing::FloatNear;
using ::testing::Pointwise;

constexpr int kWidth = 75;  // no whole number of vectors

cv::Mat1b random_rows(std::uint64_t seed) {
  cv::Mat1b out(kPieceSide, kWidth);
  cv::RNG(seed).fill(out, cv::RNG::UNIFORM, 0, 256);
  return out;
}

std::vector<float> correlations(const cv::Mat1b& from, int column, const cv::Mat1b& to) {
  std::vector<float> out(kWidth - kPieceSide + 1);
  correlate(Piece(from.ptr() + column, kWidth), to.ptr(), kWidth, out);
  return out;
}

/// Returns the correlation coefficient of two pieces, by its definition.
float coefficient(const cv::Mat1b& a, const cv::Mat1b& b) {
  cv::Mat1d from, to;
  a.convertTo(from, CV_64F);
  b.convertTo(to, CV_64F);
  from -= cv::mean(from);
  to -= cv::mean(to);
  return static_cast<float>(from.dot(to) / (cv::norm(from) * cv::norm(to)));
}

TEST(Piece, CorrelatesByTheDefinitionWithEveryPieceOfARow) {
  const cv::Mat1b from = random_rows(1), to = random_rows(2);
  std::vector<float> expected;
  for (int x = 0; x + kPieceSide <= kWidth; ++x)
    expected.push_back(
        coefficient(from.colRange(20, 20 + kPieceSide), to.colRange(x, x + kPieceSide)));
  EXPECT_THAT(correlations(from, 20, to), Pointwise(FloatNear(1e-5F), expected));
}

TEST(Piece, IsFoundWhereItIsInAnotherLight) {
  const cv::Mat1b from = random_rows(1);
  cv::Mat1b darker;
  from.convertTo(darker, -1, 0.5, 40);
  const std::vector<float> found = correlations(from, 31, darker);
  EXPECT_EQ(std::ranges::max_element(found) - found.begin(), 31);
  EXPECT_NEAR(found[31], 1, 1e-4);
}

TEST(Piece, WithoutTextureCorrelatesWithNothing) {
  const cv::Mat1b flat(kPieceSide, kWidth, std::uint8_t{200});
  EXPECT_THAT(correlations(flat, 5, random_rows(1)), Each(FloatNear(0, 1e-5F)));
  EXPECT_THAT(correlations(random_rows(1), 5, flat), Each(FloatNear(0, 1e-5F)));
}

TEST(Changes, AreSummedByColumn) {
  const cv::Mat1b a = random_rows(1), b = random_rows(2);
  std::vector<std::uint16_t> sums(kWidth), expected(kWidth);
  sum_changes(a.ptr(), b.ptr(), kWidth, sums);
  for (int x = 0; x < kWidth; ++x)
    for (int y = 0; y < kPieceSide; ++y)
      expected[static_cast<std::size_t>(x)] +=
          static_cast<std::uint16_t>(std::abs(a(y, x) - b(y, x)));
  EXPECT_EQ(sums, expected);
}

}  // namespace
}  // namespace hypotrack
