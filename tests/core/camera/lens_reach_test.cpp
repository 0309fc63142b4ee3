#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "scene/visible_share.hpp"
#include "test_cameras.hpp"

namespace hypotrack {
namespace {

constexpr int kSteps = 24;

/// Whether the image shows a grid over the bounds, its outermost half pixel included.
bool shows_grid(const Camera& camera, const Eigen::Matrix3d& camera_from_ideal, const Bounds& b) {
  for (int j = 0; j <= kSteps; ++j) {
    for (int i = 0; i <= kSteps; ++i) {
      const double u = b.x0 + b.width() * i / kSteps;
      const double v = b.y0 + b.height() * j / kSteps;
      const Eigen::Vector2d p = project(camera, camera_from_ideal * Eigen::Vector3d(u, v, 1));
      const bool shown = p.x() >= -0.5 && p.y() >= -0.5 && p.x() < camera.width - 0.5 &&
                         p.y() < camera.height - 0.5;
      if (!shown) return false;  // NaN, too
    }
  }
  return true;
}

TEST(LensReach, NeverClaimsWhatAnImageDoesNotShow) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> share(-1, 1);
  std::uniform_real_distribution<double> size(0.01, 0.5);
  int claimed = 0, shown = 0, hidden = 0;
  for (const int lens : {0, 4, 5, 8, 12, 14, -4}) {
    for (int i = 0; i < 4000; ++i) {
      Camera camera = test::lens_camera(lens);
      // From weak to absurd: some lenses fold back within the image, or divide by zero.
      for (double& k : camera.distortion) k *= i % 3 == 0 ? 1 : 8 * share(random);
      camera.fx *= 1 + 0.7 * share(random);
      const Eigen::Vector3d turn =
          (i % 5 == 0 ? 1.2 : 0.25) * Eigen::Vector3d(share(random), share(random), share(random));
      const Eigen::Matrix3d camera_from_ideal = test::pose(turn, {0, 0, 0}).linear();
      const double x = share(random), y = 0.6 * share(random);
      const double width = size(random), height = size(random);
      const Bounds bounds{static_cast<float>(x - width / 2), static_cast<float>(x + width / 2),
                          static_cast<float>(y - height / 2), static_cast<float>(y + height / 2)};
      const bool truth = shows_grid(camera, camera_from_ideal, bounds);
      const bool claim = surely_shown(camera, camera_from_ideal, bounds);
      ASSERT_TRUE(truth || !claim) << lens << ", " << i;
      claimed += claim;
      shown += truth;
      hidden += !truth;
    }
  }
  EXPECT_GT(claimed, 0.8 * shown);
  EXPECT_GT(shown, 3000);
  EXPECT_GT(hidden, 3000);
}

TEST(LensReach, ClaimsUpToAPixelWithoutALens) {
  const Camera camera = test::lens_camera(0);
  const auto column = [&](double pixel) { return float((pixel - camera.cx) / camera.fx); };
  const auto row = [&](double pixel) { return float((pixel - camera.cy) / camera.fy); };
  const auto claims = [&](double left, double right, double top, double bottom) {
    const Bounds bounds{column(left), column(right), row(top), row(bottom)};
    return surely_shown(camera, Eigen::Matrix3d::Identity(), bounds);
  };
  EXPECT_TRUE(claims(0.6, 1278.4, 0.6, 718.4));
  EXPECT_FALSE(claims(-0.6, 600, 300, 400));
  EXPECT_FALSE(claims(600, 1279.6, 300, 400));
  EXPECT_FALSE(claims(600, 700, -0.6, 400));
  EXPECT_FALSE(claims(600, 700, 300, 719.6));
}

TEST(LensReach, SaysNothingOfWhatLiesAsideOrBehind) {
  const Bounds bounds{-0.1f, 0.1f, -0.1f, 0.1f};
  for (const int lens : {0, 8, -4}) {
    const Camera camera = test::lens_camera(lens);
    EXPECT_TRUE(surely_shown(camera, Eigen::Matrix3d::Identity(), bounds)) << lens;
    for (const double angle : {0.5, 0.9, 1.0}) {
      const auto turned = test::pose({0, angle * std::numbers::pi, 0}, {0, 0, 0});
      EXPECT_FALSE(surely_shown(camera, turned.linear(), bounds)) << lens << ", " << angle;
    }
  }
}

}  // namespace
}  // namespace hypotrack
