#include "distinctiveness.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace hypotrack::stereo_color {
namespace {

std::vector<std::uint8_t> all_valid(std::size_t n) { return std::vector<std::uint8_t>(n, 255); }

std::vector<float> image(int width, int height, float (*grey)(int x, int y)) {
  std::vector<float> out;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) out.push_back(grey(x, y));
  }
  return out;
}

TEST(PrincipalCurvatures, OfARampAreNineSquaredSlopesAndZero) {
  const auto grey = image(7, 7, [](int x, int) { return 0.1f * static_cast<float>(x); });
  const Curvatures c = principal_curvatures(grey, all_valid(49), 7, 7);
  const std::size_t centre = 3 * 7 + 3;
  EXPECT_NEAR(c.major[centre], 9 * 0.01, 1e-6);
  EXPECT_NEAR(c.minor[centre], 0, 1e-7);
}

TEST(PrincipalCurvatures, DoNotDependOnTheDirectionOfAnEdge) {
  const auto grey =
      image(7, 7, [](int x, int y) { return 0.03f * static_cast<float>(x) + 0.04f * y; });
  const Curvatures c = principal_curvatures(grey, all_valid(49), 7, 7);
  EXPECT_NEAR(c.major[3 * 7 + 3], 9 * 0.0025, 1e-6);
  EXPECT_NEAR(c.minor[3 * 7 + 3], 0, 1e-7);
}

TEST(PrincipalCurvatures, OfACornerAreTheTwoEigenvalues) {
  // A bright quadrant x >= 3, y >= 3. Around (3, 3) the gradient (in halves) is (0 0), (0 0), (1 0)
  // with rows y = 2, 3, 4 and columns x = 2, 3, 4:
  //   y=2: (0,0) (0,.5) (0,.5)   y=3: (.5,0) (.5,.5) (0,.5)   y=4: (.5,0) (.5,0) (0,0)
  // so sum gx^2 = 4/4, sum gy^2 = 4/4, sum gx gy = 1/4.
  const auto grey = image(8, 8, [](int x, int y) { return x >= 3 && y >= 3 ? 1.0f : 0.0f; });
  const Curvatures c = principal_curvatures(grey, all_valid(64), 8, 8);
  EXPECT_NEAR(c.major[3 * 8 + 3], 1.25, 1e-6);
  EXPECT_NEAR(c.minor[3 * 8 + 3], 0.75, 1e-6);
}

TEST(PrincipalCurvatures, IgnoreGradientsAcrossInvalidPixels) {
  // The right half is outside the image, black; the left half is flat.
  const auto grey = image(8, 8, [](int x, int) { return x < 4 ? 0.8f : 0.0f; });
  auto valid = all_valid(64);
  for (int y = 0; y < 8; ++y) {
    for (int x = 4; x < 8; ++x) valid[static_cast<std::size_t>(y * 8 + x)] = 0;
  }
  const Curvatures c = principal_curvatures(grey, valid, 8, 8);
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 4; ++x) EXPECT_EQ(c.major[static_cast<std::size_t>(y * 8 + x)], 0) << x;
  }
}

double sigmoid(double x) { return 1 / (1 + std::exp(-x)); }

TEST(Distinctiveness, OfAnOddCountIsAboutTheMiddlePixel) {
  const Curvatures c{{1, 4, 9}, {0.5f, 0, 9}};
  const double d[] = {std::log(std::sqrt(1.25)), std::log(4.0), std::log(std::sqrt(162.0))};
  const double a[] = {std::atan(0.5), 0, std::atan(1.0)};
  const auto out = distinctiveness(c, all_valid(3), 0);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(out[i], sigmoid(d[i] - d[1]) * sigmoid(a[i] - a[0]), 1e-6) << i;
  }
}

TEST(Distinctiveness, OfAnEvenCountIsAboutTheMeanOfTheMiddleTwo) {
  const Curvatures c{{2, 16, 4, 1}, {0, 4, 3, 1}};
  const double d[] = {std::log(2.0), std::log(std::hypot(16.0, 4.0)), std::log(5.0),
                      std::log(std::hypot(1.0, 1.0))};
  const double a[] = {0, std::atan(0.25), std::atan(0.75), std::atan(1.0)};
  const double m_d = (d[0] + d[2]) / 2, m_a = (a[1] + a[2]) / 2;
  const auto out = distinctiveness(c, all_valid(4), 0);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(out[i], sigmoid(d[i] - m_d) * sigmoid(a[i] - m_a), 1e-6) << i;
  }
}

TEST(Distinctiveness, OfAFlatImageIsFiniteAndAQuarter) {
  const std::vector<float> grey(36, 0.4f);
  const auto out =
      distinctiveness(principal_curvatures(grey, all_valid(36), 6, 6), all_valid(36), 0.1);
  for (const float c : out) EXPECT_NEAR(c, 0.25, 1e-6);  // both sigmoids at their medians
}

TEST(Distinctiveness, OfAFlatPixelAmongTexturedOnesIsZeroByTheGuardedLogarithm) {
  const Curvatures c{{0, 1, 1}, {0, 0.5f, 0.5f}};
  const auto out = distinctiveness(c, all_valid(3), 0);
  const double d = std::log(1e-12) - std::log(std::sqrt(1.25));
  EXPECT_NEAR(out[0] / (sigmoid(d) * sigmoid(0 - std::atan(0.5))), 1, 1e-4);
  EXPECT_LT(out[0], 1e-11);
}

TEST(Distinctiveness, BelowTheThresholdIsZeroAndAtItStays) {
  const Curvatures c{{1, 4, 9}, {0.5f, 0, 9}};
  const auto all = distinctiveness(c, all_valid(3), 0);
  const auto some = distinctiveness(c, all_valid(3), all[1]);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(some[i], all[i] < all[1] ? 0 : all[i]) << i;
  EXPECT_GT(some[1], 0);
  EXPECT_EQ(some[0], 0);
}

TEST(Distinctiveness, InvalidPixelsHaveNoneAndDoNotMoveTheMedians) {
  const Curvatures three{{1, 4, 9}, {0.5f, 0, 9}};
  const Curvatures five{{1, 700, 4, 9, 800}, {0.5f, 600, 0, 9, 1}};
  const auto expected = distinctiveness(three, all_valid(3), 0);
  const auto out = distinctiveness(five, {1, 0, 1, 1, 0}, 0);
  EXPECT_EQ(out, (std::vector<float>{expected[0], 0, expected[1], expected[2], 0}));
}

TEST(Distinctiveness, OfNoValidPixelIsZero) {
  EXPECT_EQ(distinctiveness({{1, 2}, {0, 0}}, {0, 0}, 0.1), (std::vector<float>{0, 0}));
}

TEST(Distinctiveness, DoesNotDependOnTheContrastOfTheImage) {
  const auto strong = image(16, 16, [](int x, int y) {
    return 0.5f + 0.4f * std::sin(0.9f * static_cast<float>(x * x) + 1.7f * static_cast<float>(y));
  });
  auto weak = strong;
  for (float& g : weak) g *= 0.25f;
  const auto valid = all_valid(256);
  const auto a = distinctiveness(principal_curvatures(strong, valid, 16, 16), valid, 0);
  const auto b = distinctiveness(principal_curvatures(weak, valid, 16, 16), valid, 0);
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-4);
}

}  // namespace
}  // namespace hypotrack::stereo_color
