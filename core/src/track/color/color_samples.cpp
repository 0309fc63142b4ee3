#include "track/color/color_samples.hpp"

#include <algorithm>
#include <cmath>

#include "cost/draw/hypothesis_drawer.hpp"
#include "hypotrack/plugin/stereo_pixels_map-inl.hpp"
#include "hypotrack/plugin/view_pixels.hpp"
#include "track/color_at.hpp"

namespace hypotrack::internal {
namespace {

constexpr int kGrid = 64;
// Largest depth difference of neighbouring grid points of one surface, in metres. Grid points are
// some 3 mm apart on a model of 0.2 m, so the surface may be slanted by 60 degrees.
constexpr float kSameSurface = 0.006f;

/// Returns the tile's camera with kGrid x kGrid pixels.
TileCamera coarse(const TileCamera& tile) {
  TileCamera out = tile;
  const double x = static_cast<double>(kGrid) / tile.width;
  const double y = static_cast<double>(kGrid) / tile.height;
  out.width = out.height = kGrid;
  out.fx *= x;
  out.fy *= y;
  out.cx = (tile.cx + 0.5) * x - 0.5;
  out.cy = (tile.cy + 0.5) * y - 0.5;
  return out;
}

float depth_at(const DepthTile& tile, int x, int y) {
  return tile.inverse_depth[y * tile.stride + x];
}

/// Returns whether a pixel and its four neighbours show the same surface.
bool is_interior(const DepthTile& tile, int x, int y) {
  if (x < 1 || y < 1 || x + 1 >= tile.width || y + 1 >= tile.height) return false;
  const float w = depth_at(tile, x, y);
  const auto same = [&](int u, int v) {
    return scalar::same_depth(w, depth_at(tile, u, v), kSameSurface);
  };
  return w > 0 && same(x - 1, y) && same(x + 1, y) && same(x, y - 1) && same(x, y + 1);
}

/// Computes the normal of the plane through neighbouring points: 1/z is linear in the image of a
/// plane.
Eigen::Vector3f normal_at(const DepthTile& tile, const TileCamera& camera, int x, int y) {
  const double dx = (double{depth_at(tile, x + 1, y)} - depth_at(tile, x - 1, y)) / 2;
  const double dy = (double{depth_at(tile, x, y + 1)} - depth_at(tile, x, y - 1)) / 2;
  const double at_centre = depth_at(tile, x, y) - dx * (x - camera.cx) - dy * (y - camera.cy);
  const Eigen::Vector3d inwards(dx * camera.fx, dy * camera.fy, at_centre);
  return (camera.camera_from_world.linear().transpose() * -inwards.normalized()).cast<float>();
}

Eigen::Matrix3Xf columns(const std::vector<Eigen::Vector3f>& vectors) {
  Eigen::Matrix3Xf out(3, static_cast<Eigen::Index>(vectors.size()));
  for (std::size_t i = 0; i < vectors.size(); ++i)
    out.col(static_cast<Eigen::Index>(i)) = vectors[i];
  return out;
}

/// Looks up a camera's image at positions of its grid.
struct ImageLookup {
  const Resampler& camera;
  TileIntrinsics grid;
  const cv::Mat& image;

  bool operator()(float column, float row, std::array<float, 3>& color) const {
    return color_at(image, image_point(camera.lens(), grid, column, row), color);
  }
};

/// Looks up a tile at positions of the grid that covers it.
struct TileLookup {
  const TileView& tile;

  bool operator()(float column, float row, std::array<float, 3>& color) const {
    const float x = static_cast<float>(tile.camera.width) / kGrid;
    const float y = static_cast<float>(tile.camera.height) / kGrid;
    const ImagePoint p{(column + 0.5F) * x - 0.5F, (row + 0.5F) * y - 0.5F};
    if (!color_at(tile.color, p, color)) return false;
    return tile.valid.at<unsigned char>(static_cast<int>(p.y), static_cast<int>(p.x)) != 0;
  }
};

/// Maps a point of the first view's grid to another view's. Returns false if that view does not see
/// it.
bool seen_by_other(const DepthTile& other, const StereoMap& map, int x, int y, float w,
                   scalar::Mapped<float>& at) {
  const auto fx = static_cast<float>(x), fy = static_cast<float>(y);
  at = map.rectified ? scalar::map_pixel<true>(map, fx, fy, w)
                     : scalar::map_pixel<false>(map, fx, fy, w);
  if (!scalar::lands_inside<false>(map, at)) return false;
  const int column = static_cast<int>(pixel::round(at.u));
  const int row = static_cast<int>(pixel::round(at.v));
  return is_interior(other, column, row) &&
         scalar::same_depth(at.inverse_depth, depth_at(other, column, row), kSameSurface);
}

}  // namespace

struct ColorSampler::Impl {
  explicit Impl(const Scene& scene) : plan(scene, ScenePlan::Surface::simplified), drawer(plan) {}

  ScenePlan plan;
  HypothesisDrawer drawer;
  Observation grid;  // cameras only
  FrameProjection projection;

  /// Calls visit(x, y, at) with the grid's points that are sampled, and where another view has
  /// them.
  template <class Visit>
  void for_pairs(std::size_t other, const Visit& visit) const;
  /// Takes samples; `here` and `there` look up the two views at positions of their grids.
  template <class LookUp>
  ColorSamples take(const LookUp& here, const LookUp& there, std::size_t other,
                    bool with_normals) const;
};

ColorSampler::ColorSampler(const Scene& scene) : impl_(std::make_unique<Impl>(scene)) {}
ColorSampler::~ColorSampler() = default;

void ColorSampler::draw(const Observation& header, const Eigen::VectorXd& state) {
  Impl& self = *impl_;
  self.grid.rectified = header.rectified;
  self.grid.views.resize(header.views.size());
  for (std::size_t i = 0; i < header.views.size(); ++i) {
    self.grid.views[i].camera = coarse(header.views[i].camera);
  }
  self.projection = FrameProjection(self.grid);
  self.drawer.prepare(self.projection);
  self.drawer.draw({state.data(), static_cast<std::size_t>(state.size())});
}

ColorSamples ColorSampler::take(const Frame& frame, std::span<const Resampler> cameras,
                                std::size_t other, bool with_normals) const {
  const auto& views = impl_->grid.views;
  const cv::Mat &first = frame.views[0].color, &second = frame.views[other].color;
  if (first.empty() || second.empty()) return {};
  const ImageLookup here{cameras[0], intrinsics(views[0].camera), first};
  const ImageLookup there{cameras[other], intrinsics(views[other].camera), second};
  return impl_->take(here, there, other, with_normals);
}

ColorSamples ColorSampler::take(const Observation& tiles, std::size_t other,
                                bool with_normals) const {
  if (tiles.views[0].color.empty() || tiles.views[other].color.empty()) return {};
  return impl_->take(TileLookup{tiles.views[0]}, TileLookup{tiles.views[other]}, other,
                     with_normals);
}

template <class Visit>
void ColorSampler::Impl::for_pairs(std::size_t other, const Visit& visit) const {
  const StereoMap map = stereo_map(grid, 0, static_cast<int>(other));
  const DepthTile& tile = drawer.tiles()[0];
  for (int y = tile.y0; y < tile.y1; ++y) {
    for (int x = tile.x0 + (tile.x0 + y) % 2; x < tile.x1; x += 2) {
      if (!is_interior(tile, x, y)) continue;
      scalar::Mapped<float> at{};
      if (seen_by_other(drawer.tiles()[other], map, x, y, depth_at(tile, x, y), at))
        visit(x, y, at);
    }
  }
}

template <class LookUp>
ColorSamples ColorSampler::Impl::take(const LookUp& here, const LookUp& there, std::size_t other,
                                      bool with_normals) const {
  ColorSamples samples;
  std::vector<Eigen::Vector3f> normals;
  for_pairs(other, [&](int x, int y, const scalar::Mapped<float>& at) {
    std::array<float, 3> first{}, second{};
    if (!here(static_cast<float>(x), static_cast<float>(y), first)) return;
    if (!there(at.u, at.v, second)) return;
    if (with_normals) normals.push_back(normal_at(drawer.tiles()[0], grid.views[0].camera, x, y));
    for (std::size_t i = 0; i < 3; ++i) {
      samples.first[i].push_back(first[i]);
      samples.other[i].push_back(second[i]);
    }
  });
  samples.normals = columns(normals);
  return samples;
}

ColorSampler::NormalGrid ColorSampler::normals(std::size_t view) const {
  const DepthTile& tile = impl_->drawer.tiles()[view];
  NormalGrid grid{cv::Mat::zeros(kGrid, kGrid, CV_8U), {}};
  std::vector<Eigen::Vector3f> normals;
  for (int y = tile.y0; y < tile.y1; ++y) {
    for (int x = tile.x0; x < tile.x1; ++x) {
      if (!is_interior(tile, x, y)) continue;
      grid.inside.at<unsigned char>(y, x) = 255;
      normals.push_back(normal_at(tile, impl_->grid.views[view].camera, x, y));
    }
  }
  grid.normals = columns(normals);
  return grid;
}

ViewDirections ColorSampler::directions(std::size_t other) const {
  const auto& views = impl_->grid.views;
  const DepthTile& tile = impl_->drawer.tiles()[0];
  const TileCamera& camera = views[0].camera;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int points = 0;
  for (int y = tile.y0; y < tile.y1; ++y) {
    for (int x = tile.x0; x < tile.x1; ++x) {
      const double w = depth_at(tile, x, y);
      if (w <= 0) continue;
      sum += Eigen::Vector3d((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1) / w;
      ++points;
    }
  }
  const Eigen::Vector3d middle = camera.camera_from_world.inverse() * (sum / std::max(points, 1));
  const auto to = [&](const TileCamera& c) -> Eigen::Vector3d {
    return (c.camera_from_world.inverse().translation() - middle).normalized();
  };
  return {to(camera), to(views[other].camera)};
}

}  // namespace hypotrack::internal
