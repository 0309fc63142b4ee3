#include "cost/cuda/tiles/tile_pixels.hpp"

#include "cost/cuda/tiles/view_resampling.hpp"
#include "tile_cases.hpp"

namespace hypotrack {
namespace {

/// What the kernels do, on the host.
struct HostTile {
  HostTile(const Resampler& camera, const TileCamera& tile, const ResamplePlan& plan,
           const View& view) {
    cuda::ViewResampling out = cuda::view_resampling(camera, tile, plan);
    if (!view.color.empty()) color = view.color(plan.touched).clone();
    if (!view.mask.empty()) mask = view.mask(plan.touched).clone();
    const cuda::ImagePart& m = out.measured;
    if (!view.depth.empty()) measured = view.depth(cv::Rect(m.x, m.y, m.width, m.height)).clone();
    out.color = color.empty() ? nullptr : color.ptr();
    out.mask = mask.empty() ? nullptr : mask.ptr();
    out.depth = measured.empty() ? nullptr : measured.ptr<float>();
    const int columns = out.touched.width / out.blocks;
    const int rows = out.touched.height / out.blocks;
    if (out.color || out.mask) {
      means.resize(static_cast<std::size_t>(columns * rows));
      out.means = means.data();
      for (int i = 0; i < columns * rows; ++i) {
        means[static_cast<std::size_t>(i)] = cuda::block_mean(out, i % columns, i / columns);
      }
    }
    const auto map = [&](int column, int row) {
      return image_point(out.lens, out.camera, static_cast<float>(column), static_cast<float>(row));
    };
    for (int v = 0; v < out.height; ++v) {
      for (int u = 0; u < out.width; ++u) {
        pixels.push_back(cuda::tile_pixel(out, map, u, v));
        if (out.depth) depth.push_back(cuda::tile_depth(out, map(u, v), u, v));
      }
    }
  }

  cv::Mat color, mask, measured;
  std::vector<std::uint32_t> means, pixels;
  std::vector<float> depth;
};

TEST(TilePixels, AreThoseThatOpenCvMakes) {
  for (const test::TileCase& c : test::tile_cases()) {
    SCOPED_TRACE(c.name);
    const Resampler camera(c.camera, c.camera_from_ideal);
    const double scale = scale_at_centre(camera.lens(), c.tile);
    const ResamplePlan plan = plan_resampling(camera.lens(), c.tile, camera.image_size(), scale);
    const HostTile tile(camera, c.tile, plan, c.view);
    test::expect_same_tile(camera.resample(c.view, c.tile, plan), tile.pixels, tile.depth);
  }
}

TEST(TilePixels, AreMappedAsTheCpuMapsThem) {
  const std::vector<test::TileCase> cases = test::tile_cases();
  for (std::size_t i = 0; i < cases.size(); i += 6) {
    const test::TileCase& c = cases[i];
    SCOPED_TRACE(c.name);
    const Resampler camera(c.camera, c.camera_from_ideal);
    const double scale = scale_at_centre(camera.lens(), c.tile);
    ResamplePlan plan = plan_resampling(camera.lens(), c.tile, camera.image_size(), scale);
    plan.colors = {{0.9f, 0.75f, 1.0f}, {60.0f, -40.0f, 3.5f}};
    const HostTile tile(camera, c.tile, plan, c.view);
    test::expect_same_tile(camera.resample(c.view, c.tile, plan), tile.pixels, tile.depth);
  }
}

}  // namespace
}  // namespace hypotrack
