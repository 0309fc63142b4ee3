#include "hypotrack/plugin/pixel.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "color_consistency-inl.hpp"
#include "hypotrack/plugin/stereo_pixels_map-inl.hpp"
#include "hypotrack/plugin/view_pixels.hpp"

namespace hypotrack {
namespace {

using scalar::Mapped;

TEST(Pixel, ExpIsWithinAMillionthOfTheLibrarys) {
  for (double x = -79.9; x < 87.9; x += 0.0137) {
    const double exact = std::exp(static_cast<double>(static_cast<float>(x)));
    EXPECT_NEAR(pixel::exp(static_cast<float>(x)) / exact, 1.0, 5e-7) << x;
  }
}

TEST(Pixel, ExpOfZeroIsExactlyOne) { EXPECT_EQ(pixel::exp(0.0f), 1.0f); }

TEST(Pixel, ExpStaysFiniteAndPositiveFarOutside) {
  EXPECT_EQ(pixel::exp(-1e9f), pixel::exp(-80.0f));
  EXPECT_GT(pixel::exp(-1e9f), 0.0f);
  EXPECT_TRUE(std::isfinite(pixel::exp(1e9f)));
}

TEST(Pixel, PackingEightBitValuesIsExact) {
  for (int k = 0; k <= 255; ++k) {
    const std::uint32_t word = pack_unorm16(static_cast<float>(k) / 255.0f, 1.0f);
    EXPECT_EQ(word & 0xFFFFu, static_cast<std::uint32_t>(k) * 257u);
    EXPECT_EQ(word >> 16, 65535u);
  }
  EXPECT_EQ(pack_unorm16(-1.0f, 7.0f), 65535u << 16);
}

TEST(Pixel, ColorConsistencyIsTheSmallerWeightTimesTheExponential) {
  const stereo_color::scalar::ColorSample<float> l{0.5f, 0.4f, 0.3f, 0.6f};
  const stereo_color::scalar::ColorSample<float> r{0.51f, 0.38f, 0.32f, 0.25f};
  // Colour distance: |(-0.01, 0.02, -0.02)| = 0.03.
  const auto s = [](const auto& a, const auto& b, float beta) {
    return stereo_color::scalar::color_consistency<float>(a, b, {beta, 0.0f, false});
  };
  EXPECT_NEAR(s(l, r, 100.0f), 0.25 * std::exp(-3.0), 1e-6);
  EXPECT_NEAR(s(l, l, 100.0f), 0.6, 1e-7);
  EXPECT_NEAR(s(l, r, 0.0f), 0.25, 1e-7);
}

TEST(Pixel, ColorConsistencyFallsWithTheSquareAndPaysTheCoveragePenalty) {
  using stereo_color::scalar::color_consistency;
  const stereo_color::scalar::ColorSample<float> l{0.5f, 0.4f, 0.3f, 0.6f};
  const stereo_color::scalar::ColorSample<float> r{0.51f, 0.38f, 0.32f, 0.25f};
  EXPECT_NEAR(color_consistency<float>(l, r, {50.0f, 0.0f, true}), 0.25 * std::exp(-2.25), 1e-6);
  EXPECT_NEAR(color_consistency<float>(l, l, {50.0f, 0.2f, true}), 0.6 * 0.8, 1e-7);
  EXPECT_NEAR(color_consistency<float>(l, r, {100.0f, 0.2f, false}), 0.25 * (std::exp(-3.0) - 0.2),
              1e-6);
}

TEST(Pixel, SameDepthComparesDepthsAndNothingIsNeverTheSame) {
  EXPECT_TRUE(scalar::same_depth(1 / 0.5f, 1 / 0.5029f, 0.003f));
  EXPECT_FALSE(scalar::same_depth(1 / 0.5f, 1 / 0.5031f, 0.003f));
  EXPECT_TRUE(scalar::same_depth(1 / 0.5f, 1 / 0.4971f, 0.003f));
  EXPECT_FALSE(scalar::same_depth(1 / 0.5f, 1 / 0.4969f, 0.003f));
  EXPECT_FALSE(scalar::same_depth(1 / 0.5f, 0.0f, 0.003f));
}

Observation rectified_pair() {
  Observation o;
  o.rectified = true;
  o.views.resize(2);
  o.views[0].camera = {128, 128, 700, 700, 64, 60, Eigen::Isometry3d::Identity()};
  o.views[1].camera = {128, 128, 700, 700, 200, 60, Eigen::Isometry3d::Identity()};
  o.views[1].camera.camera_from_world.translation().x() = -0.1;
  return o;
}

TEST(StereoMap, OfARectifiedPairIsADisparity) {
  const StereoMap map = stereo_map(rectified_pair(), 0, 1);
  const Mapped<float> m = scalar::map_pixel<true>(map, 30.0f, 40.0f, 2.0f);
  EXPECT_NEAR(m.u, 30 + (200 - 64) - 700 * 0.1 * 2, 1e-4);
  EXPECT_EQ(m.v, 40.0f);
  EXPECT_EQ(m.inverse_depth, 2.0f);
}

TEST(StereoMap, OfARectifiedPairIsTheGeneralOne) {
  Observation o = rectified_pair();
  const StereoMap special = stereo_map(o, 1, 0);
  o.rectified = false;
  const StereoMap general = stereo_map(o, 1, 0);
  const auto a = scalar::map_pixel<true>(special, 77.0f, 13.0f, 1.7f);
  const auto b = scalar::map_pixel<false>(general, 77.0f, 13.0f, 1.7f);
  EXPECT_NEAR(a.u, b.u, 1e-3);
  EXPECT_NEAR(a.v, b.v, 1e-3);
  EXPECT_NEAR(a.inverse_depth, b.inverse_depth, 1e-6);
}

TEST(StereoMap, OfAGeneralPairIsProjectionOfTheSurfacePoint) {
  Observation o;
  o.views.resize(2);
  o.views[0].camera = {128, 128, 650, 655, 70, 50, Eigen::Isometry3d::Identity()};
  o.views[1].camera = {96, 96, 500, 510, 40, 45, Eigen::Isometry3d::Identity()};
  o.views[0].camera.camera_from_world.translate(Eigen::Vector3d(0.02, 0.01, -0.03));
  o.views[1].camera.camera_from_world =
      Eigen::AngleAxisd(0.3, Eigen::Vector3d(0.2, 1, 0.1).normalized()) *
      Eigen::Translation3d(-0.15, 0.02, 0.01);
  const double z = 0.55;
  const Eigen::Vector3d p_left((33 - 70) / 650.0 * z, (81 - 50) / 655.0 * z, z);
  const Eigen::Vector3d p = o.views[1].camera.camera_from_world *
                            (o.views[0].camera.camera_from_world.inverse() * p_left);
  const auto m =
      scalar::map_pixel<false>(stereo_map(o, 0, 1), 33.0f, 81.0f, static_cast<float>(1 / z));
  EXPECT_NEAR(m.u, 500 * p.x() / p.z() + 40, 1e-3);
  EXPECT_NEAR(m.v, 510 * p.y() / p.z() + 45, 1e-3);
  EXPECT_NEAR(m.inverse_depth, 1 / p.z(), 1e-6);
}

TEST(StereoMap, PixelsReachHalfAPixelBeyondTheirCentres) {
  const StereoMap map = stereo_map(rectified_pair(), 0, 1);
  const auto inside = [&](float u) {
    return scalar::lands_inside<true>(map, Mapped<float>{u, 0.0f, 2.0f});
  };
  EXPECT_TRUE(inside(-0.49f));
  EXPECT_FALSE(inside(-0.51f));
  EXPECT_TRUE(inside(127.49f));
  EXPECT_FALSE(inside(127.51f));
}

TEST(StereoMap, PointsBehindTheOtherCameraLandNowhere) {
  const StereoMap map = stereo_map(rectified_pair(), 0, 1);
  EXPECT_TRUE(scalar::lands_inside<false>(map, Mapped<float>{5.0f, 5.0f, 2.0f}));
  EXPECT_FALSE(scalar::lands_inside<false>(map, Mapped<float>{5.0f, 5.0f, -2.0f}));
  EXPECT_FALSE(scalar::lands_inside<false>(map, Mapped<float>{NAN, 5.0f, 2.0f}));
}

}  // namespace
}  // namespace hypotrack
