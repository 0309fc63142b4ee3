#include "tile/resample_plan.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "test_cameras.hpp"
#include "tile/resample.hpp"

namespace hypotrack {
namespace {

/// A tile whose middle looks along (x, y, 1) and that is about `scale` image pixels per pixel.
TileCamera tile_at(double x, double y, double scale, int size) {
  TileCamera tile;
  tile.width = tile.height = size;
  tile.fx = tile.fy = 700 / scale;
  tile.cx = 0.5 * (size - 1) - tile.fx * x;
  tile.cy = 0.5 * (size - 1) - tile.fy * y;
  return tile;
}

/// The image pixels that linear lookups of valid tile pixels read, blocks and samples included.
cv::Rect2d needed(const Resampler& resampler, const TileCamera& tile, double reach,
                  bool& all_valid) {
  const ImageMap map = resampler.map(tile);
  const cv::Size image = resampler.image_size();
  all_valid = true;
  double x0 = 1e9, x1 = -1e9, y0 = 1e9, y1 = -1e9;
  for (int v = 0; v < tile.height; ++v) {
    for (int u = 0; u < tile.width; ++u) {
      const ImagePoint p{map.x.at<float>(v + 1, u + 1), map.y.at<float>(v + 1, u + 1)};
      if (!inside_image(p, image.width, image.height)) {
        all_valid = false;
        continue;
      }
      x0 = std::min(x0, p.x - reach), x1 = std::max(x1, p.x + reach);
      y0 = std::min(y0, p.y - reach), y1 = std::max(y1, p.y + reach);
    }
  }
  x0 = std::clamp(x0, 0.0, image.width - 1.0), x1 = std::clamp(x1, 0.0, image.width - 1.0);
  y0 = std::clamp(y0, 0.0, image.height - 1.0), y1 = std::clamp(y1, 0.0, image.height - 1.0);
  return {x0, y0, x1 - x0, y1 - y0};
}

class ResamplePlans : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Lenses, ResamplePlans, testing::Values(0, 4, 5, 8, 12, 14, -4));

TEST_P(ResamplePlans, TouchWhatTheLookupsReadAndLittleMore) {
  const Resampler resampler(test::lens_camera(GetParam()),
                            test::pose({0.05, 0.1, -0.3}, {0, 0, 0}).linear());
  int compared = 0;
  for (const double scale : {0.3, 1.0, 1.7, 2.5, 3.1, 6.0}) {
    for (const double x : {-0.9, -0.4, 0.0, 0.35, 0.8}) {
      for (const double y : {-0.45, 0.0, 0.3}) {
        const TileCamera tile = tile_at(x, y, scale, 128);
        const double found = scale_at_centre(resampler.lens(), tile);
        const ResamplePlan plan =
            plan_resampling(resampler.lens(), tile, resampler.image_size(), found);
        const int blocks = plan.reduction.blocks;
        bool all_valid = false;
        const cv::Rect2d need = needed(resampler, tile, 1.5 * blocks + 0.5 * found, all_valid);
        if (need.width <= 0) continue;
        compared += all_valid;
        SCOPED_TRACE(testing::Message() << scale << " at " << x << ", " << y);
        EXPECT_EQ(plan.touched.x % blocks + plan.touched.y % blocks, 0);
        EXPECT_EQ(plan.touched.width % blocks + plan.touched.height % blocks, 0);
        EXPECT_LE(plan.touched.x, need.x);
        EXPECT_LE(plan.touched.y, need.y);
        // Pixels that fill no block are left out.
        const cv::Point end = plan.touched.br();
        EXPECT_GE(end.x, std::min<double>(need.br().x, 1280 / blocks * blocks - 1));
        EXPECT_GE(end.y, std::min<double>(need.br().y, 720 / blocks * blocks - 1));
        if (!all_valid) continue;  // rows and columns beyond the border are kept, too
        EXPECT_LE(plan.touched.width, 1.15 * need.width + 6 * blocks + 8);
        EXPECT_LE(plan.touched.height, 1.15 * need.height + 6 * blocks + 8);
      }
    }
  }
  EXPECT_GT(compared, 15);
}

TEST(ResamplePlan, StaysWithinAnImageOfAnySize) {
  Camera camera = test::lens_camera(5);
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(3, 50), cv::Size(17, 2), cv::Size(64, 64)}) {
    camera.width = size.width;
    camera.height = size.height;
    const LensMap lens = make_lens_map(camera, Eigen::Matrix3d::Identity());
    for (const double scale : {0.5, 2.5, 7.0}) {
      for (const double x : {-0.95, 0.0, 0.9}) {
        const ResamplePlan plan = plan_resampling(lens, tile_at(x, 0, scale, 64), size, scale);
        EXPECT_GT(plan.touched.area(), 0);
        EXPECT_EQ(plan.touched & cv::Rect({}, size), plan.touched);
      }
    }
  }
}

TEST(ResamplePlan, TouchesEverythingWhereTheLensFoldsWithinTheTile) {
  Camera camera = test::lens_camera(5);
  camera.distortion = {0.0, 0.0, 0.0, 0.0, -1.0};  // r - r^7 falls from r = 0.72 on
  const LensMap lens = make_lens_map(camera, Eigen::Matrix3d::Identity());
  const ResamplePlan plan = plan_resampling(lens, tile_at(0.72, 0, 1, 64), {1280, 720}, 1);
  EXPECT_EQ(plan.touched, cv::Rect(0, 0, 1280, 720));
}

}  // namespace
}  // namespace hypotrack
