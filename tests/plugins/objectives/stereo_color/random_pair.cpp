#include "random_pair.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>

namespace hypotrack::stereo_color {
namespace {

Observation cameras(const PairOptions& options) {
  Observation o;
  o.rectified = options.rectified;
  o.views.resize(2);
  const double focal = 5.5 * options.size, middle = options.size / 2.0;
  for (TileView& view : o.views) {
    view.camera = {options.size, options.size, focal, focal, middle + 0.3, middle - 0.7, {}};
    view.camera.camera_from_world.setIdentity();
  }
  TileCamera& right = o.views[1].camera;
  right.camera_from_world.translation().x() = -0.1;
  right.cx += focal * 0.1 / 0.5;
  if (!options.rectified) {
    right.camera_from_world = Eigen::AngleAxisd(0.15, Eigen::Vector3d(0.1, 1, 0.3).normalized()) *
                              Eigen::Translation3d(-0.08, 0.01, 0.02);
    const Eigen::Vector3d p = right.camera_from_world * Eigen::Vector3d(0, 0, 0.5);
    right.fy = 1.02 * focal;
    right.cx = middle - right.fx * p.x() / p.z();
    right.cy = middle - right.fy * p.y() / p.z();
  }
  return o;
}

void draw_left(RandomPair& pair, const PairOptions& options, std::mt19937& rng) {
  std::uniform_real_distribution<float> uniform(0, 1);
  const int size = options.size, stride = pair.tiles[0].stride;
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const float dx = (static_cast<float>(x) / static_cast<float>(size) - 0.5f) / 0.34f;
      const float dy = (static_cast<float>(y) / static_cast<float>(size) - 0.5f) / 0.44f;
      if (dx * dx + dy * dy > 1 || uniform(rng) < 0.1f) continue;
      const float z = 0.5f + 0.02f * std::sin(3 * dx) * std::cos(2 * dy) + 0.002f * uniform(rng);
      pair.depth[0][static_cast<std::size_t>(y * stride + x)] = 1 / z;
    }
  }
}

void draw_colors(RandomPair& pair, const PairOptions& options, std::mt19937& rng) {
  std::uniform_int_distribution<int> any(0, 255), margin(0, 9);
  for (TileView& view : pair.observation.views) {
    view.color.create(options.size, options.size, CV_8UC3);
    view.valid = cv::Mat1b(options.size, options.size, uchar{255});
    for (auto& p : cv::Mat3b(view.color)) {
      const int base = any(rng);
      p = cv::Vec3b(static_cast<uchar>(base), static_cast<uchar>((base + any(rng)) / 2),
                    static_cast<uchar>(any(rng)));
    }
    view.valid.colRange(0, 5).setTo(0);
    if (!options.mask) continue;
    view.mask.create(options.size, options.size, CV_8UC1);
    for (auto& m : cv::Mat1b(view.mask)) m = margin(rng) < 2 ? 0 : 255;
  }
}

// Carries the left surface and its colours over into the right view, imperfectly.
void carry_over(RandomPair& pair, const PairOptions& options, std::mt19937& rng) {
  std::uniform_real_distribution<double> uniform(0, 1);
  std::uniform_int_distribution<int> noise(-4, 4);
  const TileCamera& a = pair.observation.views[0].camera;
  const TileCamera& b = pair.observation.views[1].camera;
  for (int y = 0; y < options.size; ++y) {
    for (int x = 0; x < options.size; ++x) {
      const float w = pair.depth[0][static_cast<std::size_t>(y * pair.tiles[0].stride + x)];
      if (w == 0 || uniform(rng) < 0.1) continue;
      const double z = 1.0 / w;
      const Eigen::Vector3d p =
          b.camera_from_world * Eigen::Vector3d((x - a.cx) / a.fx * z, (y - a.cy) / a.fy * z, z);
      const long u = std::lround(b.fx * p.x() / p.z() + b.cx);
      const long v = std::lround(b.fy * p.y() / p.z() + b.cy);
      if (u < 0 || v < 0 || u >= options.size || v >= options.size) continue;
      const double off = uniform(rng) < 0.15 ? 0.01 : 0.004 * (uniform(rng) - 0.5);
      pair.depth[1][static_cast<std::size_t>(v * pair.tiles[1].stride + u)] =
          static_cast<float>(1 / (p.z() + off));
      auto& to =
          pair.observation.views[1].color.at<cv::Vec3b>(static_cast<int>(v), static_cast<int>(u));
      const auto& from = pair.observation.views[0].color.at<cv::Vec3b>(y, x);
      for (int i = 0; i < 3; ++i) to[i] = cv::saturate_cast<uchar>(from[i] + noise(rng));
    }
  }
}

// Bounds of what is covered; values beyond the width turn into NaN.
void finish(DepthTile& tile, std::vector<float>& depth) {
  tile.x0 = tile.width;
  tile.y0 = tile.height;
  for (int y = 0; y < tile.height; ++y) {
    for (int x = 0; x < tile.stride; ++x) {
      float& w = depth[static_cast<std::size_t>(y * tile.stride + x)];
      if (x >= tile.width) w = std::numeric_limits<float>::quiet_NaN();
      if (!(w > 0)) continue;
      tile.x0 = std::min(tile.x0, x);
      tile.y0 = std::min(tile.y0, y);
      tile.x1 = std::max(tile.x1, x + 1);
      tile.y1 = std::max(tile.y1, y + 1);
    }
  }
}

}  // namespace

RandomPair::RandomPair(const PairOptions& options) : observation(cameras(options)) {
  std::mt19937 rng(options.seed);
  const int stride = options.size + options.stride_beyond;
  for (int i = 0; i < 2; ++i) {
    depth[i].assign(static_cast<std::size_t>(stride) * options.size, 0.0f);
    tiles[i].width = tiles[i].height = options.size;
    tiles[i].stride = stride;
    tiles[i].inverse_depth = depth[i].data();
  }
  draw_left(*this, options, rng);
  draw_colors(*this, options, rng);
  carry_over(*this, options, rng);
  for (int i = 0; i < 2; ++i) finish(tiles[i], depth[i]);
}

}  // namespace hypotrack::stereo_color
