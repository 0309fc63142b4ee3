#include "cost/cuda/tiles/tile_resampler.hpp"

#include <gtest/gtest.h>

#include <optional>

#include "../core/camera/tile_cases.hpp"
#include "device.hpp"
#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/gpu/runtime.cuh"

namespace hypotrack {
namespace {

/// Cameras, tiles and images of a frame that is resampled on the CPU and the GPU.
struct Tiles {
  std::vector<Resampler> cameras;
  TilePlan plan;
  Frame frame;

  void add(const test::TileCase& c) {
    cameras.emplace_back(c.camera, c.camera_from_ideal);
    const Resampler& camera = cameras.back();
    plan.header.views.emplace_back().camera = c.tile;
    const double scale = scale_at_centre(camera.lens(), c.tile);
    plan.views.push_back(plan_resampling(camera.lens(), c.tile, camera.image_size(), scale));
    frame.views.push_back(c.view);
  }
  TileView on_the_cpu(std::size_t i) const {
    return cameras[i].resample(frame.views[i], plan.header.views[i].camera, plan.views[i]);
  }
};

template <class T>
std::vector<T> download(const T* from, std::size_t count) {
  std::vector<T> to(from ? count : 0);
  cuda::check(cudaMemcpy(to.data(), from, to.size() * sizeof(T), cudaMemcpyDeviceToHost),
              "downloading");
  return to;
}

/// Whether the tiles are those that the CPU makes.
void expect_the_cpus_tiles(const Tiles& tiles, const cuda::DeviceObservation& found,
                           const cuda::Device& device) {
  cuda::check(cudaStreamSynchronize(cuda::native(device.stream())), "resampling tiles");
  for (std::size_t i = 0; i < tiles.cameras.size(); ++i) {
    const cuda::DeviceTile& tile = found.tiles[i];
    const int size = tiles.plan.header.views[i].camera.width;
    ASSERT_EQ(tile.layout.width, size);
    ASSERT_EQ(tile.layout.height, size);
    EXPECT_EQ(tile.has_color, !tiles.frame.views[i].color.empty());
    EXPECT_EQ(tile.has_mask, !tiles.frame.views[i].mask.empty());
    const auto count = static_cast<std::size_t>(size * size);
    test::expect_same_tile(tiles.on_the_cpu(i), download(tile.layout.pixels, count),
                           download(tile.layout.depth, count));
  }
}

TEST(TileResampler, MakesTheTilesOfTheCpu) {
  SKIP_WITHOUT_DEVICE();
  const cuda::Device device(0);
  for (const test::TileCase& c : test::tile_cases()) {
    SCOPED_TRACE(c.name);
    Tiles tiles;
    tiles.add(c);
    cuda::TileResampler resampler(tiles.cameras, device.limits());
    const auto found = resampler.resample(tiles.frame, tiles.plan, device.stream());
    EXPECT_EQ(found.header, &tiles.plan.header);
    expect_the_cpus_tiles(tiles, found, device);
  }
}

/// Four views that have little in common.
Tiles mixed_tiles() {
  Tiles tiles;
  const std::vector<test::TileCase> cases = test::tile_cases();
  for (const char* name : {"lens 5, scale 4.000000", "lens -4, colour only", "lens 8, depth only",
                           "image within the tile"}) {
    for (const test::TileCase& c : cases) {
      if (c.name == name) tiles.add(c);
    }
  }
  return tiles;
}

TEST(TileResampler, ResamplesEveryViewOfAFrameByItself) {
  SKIP_WITHOUT_DEVICE();
  const cuda::Device device(0);
  const Tiles tiles = mixed_tiles();
  ASSERT_EQ(tiles.cameras.size(), 4u);
  cuda::TileResampler resampler(tiles.cameras, device.limits());
  expect_the_cpus_tiles(tiles, resampler.resample(tiles.frame, tiles.plan, device.stream()),
                        device);
}

TEST(TileResampler, KeepsItsTilesInPlaceFromFrameToFrame) {
  SKIP_WITHOUT_DEVICE();
  const cuda::Device device(0);
  Tiles tiles = mixed_tiles();
  cuda::TileResampler resampler(tiles.cameras, device.limits());
  std::optional<cuda::DeviceObservation> first;
  for (int frame = 0; frame < 4; ++frame) {
    SCOPED_TRACE(frame);
    for (std::size_t i = 0; i < tiles.cameras.size(); ++i) {
      View& view = tiles.frame.views[i];
      if (!view.color.empty()) cv::rotate(view.color, view.color, cv::ROTATE_180);
      TileCamera& tile = tiles.plan.header.views[i].camera;
      tile.fx = tile.fy = 1.3 * tile.fy;
      const Resampler& camera = tiles.cameras[i];
      const double scale = scale_at_centre(camera.lens(), tile);
      tiles.plan.views[i] = plan_resampling(camera.lens(), tile, camera.image_size(), scale);
    }
    const auto found = resampler.resample(tiles.frame, tiles.plan, device.stream());
    expect_the_cpus_tiles(tiles, found, device);
    if (!first) first = found;
    for (std::size_t i = 0; i < tiles.cameras.size(); ++i) {
      EXPECT_EQ(found.tiles[i].layout.pixels, first->tiles[i].layout.pixels);
      EXPECT_EQ(found.tiles[i].layout.depth, first->tiles[i].layout.depth);
    }
  }
}

/// Copies an image into page-locked memory.
cv::Mat page_locked(const cv::Mat& image, cuda::PinnedBuffer<unsigned char>& memory) {
  if (image.empty()) return {};
  const std::size_t step = image.elemSize() * static_cast<std::size_t>(image.cols) + 64;
  memory.reserve(step * static_cast<std::size_t>(image.rows));
  cv::Mat copy(image.rows, image.cols, image.type(), memory.data(), step);
  image.copyTo(copy);
  return copy;
}

TEST(TileResampler, TakesImagesInPageLockedMemoryFromWhereTheyAre) {
  SKIP_WITHOUT_DEVICE();
  const cuda::Device device(0);
  Tiles tiles = mixed_tiles();
  std::vector<cuda::PinnedBuffer<unsigned char>> memory(8);
  for (std::size_t i = 0; i < tiles.frame.views.size(); ++i) {
    View& view = tiles.frame.views[i];
    view.color = page_locked(view.color, memory[2 * i]);  // the mask comes from ordinary memory
    view.depth = page_locked(view.depth, memory[2 * i + 1]);
  }
  cuda::TileResampler resampler(tiles.cameras, device.limits());
  expect_the_cpus_tiles(tiles, resampler.resample(tiles.frame, tiles.plan, device.stream()),
                        device);
}

TEST(TileResampler, SaysHowManyCamerasThereMayBe) {
  const std::vector<Resampler> cameras(
      5, Resampler(test::lens_camera(0), Eigen::Matrix3d::Identity()));
  const std::string message =
      test::message_of<DeviceError>([&] { cuda::TileResampler(cameras, {}); });
  EXPECT_NE(message.find("has 5 cameras, at most 4"), std::string::npos) << message;
}

}  // namespace
}  // namespace hypotrack
