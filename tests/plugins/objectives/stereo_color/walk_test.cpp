#include <gtest/gtest.h>

#include <cmath>

#include "every_target.hpp"
#include "random_pair.hpp"
#include "walk_term.hpp"

namespace hypotrack::stereo_color {
namespace {

// A feature that says where it was read: x + 1000 y.
PixelPlane<float> positions(int size) {
  PixelPlane<float> plane(size, size);
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) plane.row(y)[x] = static_cast<float>(x + 1000 * y);
  }
  return plane;
}

// The same walk by the scalar definition in double precision.
WalkCounts expected(const RandomPair& pair, const StereoMap& map, const PixelBox& region) {
  WalkCounts out;
  const DepthTile& there = pair.tiles[1];
  for (int y = region.y0; y < region.y1; ++y) {
    for (int x = region.x0; x < region.x1; ++x) {
      const double w = pair.depth[0][static_cast<std::size_t>(y * pair.tiles[0].stride + x)];
      if (w <= 0) {
        ++out.uncovered;
        continue;
      }
      out.here += x + 1000 * y;
      const auto row = [&](int i) {
        return map.a[i][0] * double{1.0 * x} + map.a[i][1] * double{1.0 * y} + map.a[i][2] +
               map.b[i] * w;
      };
      const double q = map.rectified ? 1 : row(2);
      const long u = std::lround(row(0) / q);
      const long v = map.rectified ? y : std::lround(row(1) / q);
      double w_there = 0;
      if (u >= 0 && v >= 0 && u < there.width && v < there.height) {
        w_there = there.inverse_depth[v * there.stride + u];
      }
      const bool seen = w_there > 0 && std::abs(q / w - 1 / w_there) <= 0.003;
      ++(seen ? out.seen : out.occluded);
      if (seen) out.there += static_cast<double>(u + 1000 * v);
    }
  }
  return out;
}

void expect_walk(const PairOptions& options, bool whole) {
  const RandomPair pair(options);
  const StereoMap map = stereo_map(pair.observation, 0, 1);
  const PixelBox region = whole ? whole_tile(pair.tiles[0]) : covered_box(pair.tiles[0]);
  const PixelPlane<float> plane = positions(options.size);
  const WalkCounts e = expected(pair, map, region);
  ASSERT_GT(e.seen, 0);
  ASSERT_GT(e.occluded, 0);
  on_every_target([&] {
    const WalkCounts c = walk(pair.tiles[0], pair.tiles[1], map, region, plane, plane);
    EXPECT_EQ(c.overlaps, 0);
    EXPECT_EQ(c.uncovered, e.uncovered);
    EXPECT_EQ(c.seen + c.occluded + c.uncovered, (region.x1 - region.x0) * (region.y1 - region.y0));
    EXPECT_NEAR(c.seen, e.seen, 2);  // points that land on the border of two pixels
    EXPECT_NEAR(c.here / e.here, 1, 1e-6);
    EXPECT_NEAR(c.there / e.there, 1, 2.0 / e.seen + 1e-6);
  });
}

TEST(StereoWalk, FindsEveryPixelInExactlyOneState) {
  for (const bool rectified : {true, false}) {
    for (const bool whole : {true, false}) {
      expect_walk({.rectified = rectified, .seed = 5}, whole);
      expect_walk({.rectified = rectified, .size = 37, .stride_beyond = 2, .seed = 6}, whole);
    }
  }
}

TEST(StereoWalk, LooksUpTheRightPixelsAcrossSteepDepthSteps) {
  // Neighbouring pixels alternate between two depths, 50 pixels of disparity apart: no window of
  // two vectors holds what they see.
  constexpr int kSize = 128;
  std::vector<float> left(kSize * kSize), right(kSize * kSize);
  StereoMap map{};
  map.a[0][0] = map.a[1][1] = map.a[2][2] = 1;
  map.b[0] = -50;
  map.width = map.height = kSize;
  map.rectified = true;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 51; x < kSize; ++x) {
      const int disparity = x % 2 == 0 ? 50 : 0;
      const float w = x % 2 == 0 ? 1.0f : 1e-4f;
      left[static_cast<std::size_t>(y * kSize + x)] = w;
      right[static_cast<std::size_t>(y * kSize + x - disparity)] = w;
    }
  }
  const DepthTile tiles[] = {{kSize, kSize, kSize, left.data(), 0, 0, kSize, kSize},
                             {kSize, kSize, kSize, right.data(), 0, 0, kSize, kSize}};
  const PixelPlane<float> plane = positions(kSize);
  // Every left pixel whose place in the right tile no nearer one took.
  WalkCounts e;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 51; x < kSize; ++x) {
      const int u = x % 2 == 0 ? x - 50 : x;
      if (right[static_cast<std::size_t>(y * kSize + u)] !=
          left[static_cast<std::size_t>(y * kSize + x)]) {
        continue;
      }
      ++e.seen;
      e.there += u + 1000 * y;
    }
  }
  on_every_target([&] {
    const WalkCounts c = walk(tiles[0], tiles[1], map, covered_box(tiles[0]), plane, plane);
    EXPECT_EQ(c.seen, e.seen);
    EXPECT_NEAR(c.there / e.there, 1, 1e-6);
  });
}

}  // namespace
}  // namespace hypotrack::stereo_color
