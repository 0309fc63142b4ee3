#include "cost/cuda/tile_pixels.hpp"
#include "cost/cuda/view_cut.hpp"
#include "tile_cases.hpp"

namespace hypotrack {
namespace {

/// What the kernels do, on the host.
struct HostTile {
  HostTile(const Resampler& camera, const TileCamera& tile, const CutPlan& plan, const View& view) {
    cuda::ViewCut cut = cuda::view_cut(camera, tile, plan);
    if (!view.color.empty()) color = view.color(plan.touched).clone();
    if (!view.mask.empty()) mask = view.mask(plan.touched).clone();
    const cuda::ImagePart& m = cut.measured;
    if (!view.depth.empty()) measured = view.depth(cv::Rect(m.x, m.y, m.width, m.height)).clone();
    cut.color = color.empty() ? nullptr : color.ptr();
    cut.mask = mask.empty() ? nullptr : mask.ptr();
    cut.depth = measured.empty() ? nullptr : measured.ptr<float>();
    const int columns = cut.touched.width / cut.blocks;
    const int rows = cut.touched.height / cut.blocks;
    if (cut.color || cut.mask) {
      means.resize(static_cast<std::size_t>(columns * rows));
      cut.means = means.data();
      for (int i = 0; i < columns * rows; ++i) {
        means[static_cast<std::size_t>(i)] = cuda::block_mean(cut, i % columns, i / columns);
      }
    }
    const auto map = [&](int column, int row) {
      return image_point(cut.lens, cut.camera, static_cast<float>(column), static_cast<float>(row));
    };
    for (int v = 0; v < cut.height; ++v) {
      for (int u = 0; u < cut.width; ++u) {
        pixels.push_back(cuda::tile_pixel(cut, map, u, v));
        if (cut.depth) depth.push_back(cuda::tile_depth(cut, map(u, v), u, v));
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
    const CutPlan plan = plan_cut(camera.lens(), c.tile, camera.image_size(), scale);
    const HostTile tile(camera, c.tile, plan, c.view);
    test::expect_same_tile(camera.cut(c.view, c.tile, plan), tile.pixels, tile.depth);
  }
}

TEST(TilePixels, AreMappedAsTheCpuMapsThem) {
  const std::vector<test::TileCase> cases = test::tile_cases();
  for (std::size_t i = 0; i < cases.size(); i += 6) {
    const test::TileCase& c = cases[i];
    SCOPED_TRACE(c.name);
    const Resampler camera(c.camera, c.camera_from_ideal);
    const double scale = scale_at_centre(camera.lens(), c.tile);
    CutPlan plan = plan_cut(camera.lens(), c.tile, camera.image_size(), scale);
    plan.colors = {{0.9f, 0.75f, 1.0f}, {60.0f, -40.0f, 3.5f}};
    const HostTile tile(camera, c.tile, plan, c.view);
    test::expect_same_tile(camera.cut(c.view, c.tile, plan), tile.pixels, tile.depth);
  }
}

}  // namespace
}  // namespace hypotrack
