#include "track/verify/surface_samples.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "cost/draw/hypothesis_drawer.hpp"
#include "hypotrack/plugin/stereo_pixels_map-inl.hpp"
#include "hypotrack/plugin/view_pixels.hpp"
#include "model/posing.hpp"
#include "tile/tiles.hpp"
#include "track/color_at.hpp"
#include "track/verify/ready_threads.hpp"

namespace hypotrack::internal {
namespace {

constexpr double kSamplePadding = 0.25;  // of the model's extent, so that the ring fits
constexpr int kRing = 5;                 // grid points beside the silhouette
constexpr Eigen::Index kPoints = 600;    // of the surface
constexpr float kSameSurface = 0.006f;   // metres, between neighbouring points of the grid

cv::Vec3f mapped(const ColorMap& map, const cv::Vec3f& color) {
  return {map.gain[0] * color[0] + map.offset[0], map.gain[1] * color[1] + map.offset[1],
          map.gain[2] * color[2] + map.offset[2]};
}

/// Looks up a picture through its lens.
struct Lookup {
  const LensMap& lens;
  TileIntrinsics grid;
  const cv::Mat& image;
  ColorMap colors;

  bool operator()(float column, float row, cv::Vec3f& color) const {
    if (!color_at(image, image_point(lens, grid, column, row), color)) return false;
    color = mapped(colors, color);
    return true;
  }
};

/// Returns the drawn depths of a view as a matrix of 1/z.
cv::Mat1f inverse_depths(const DepthTile& tile) {
  cv::Mat1f out(tile.height, tile.width, 0.0f);
  for (int y = std::max(tile.y0, 0); y < std::min(tile.y1, tile.height); ++y)
    std::copy_n(tile.inverse_depth + static_cast<std::ptrdiff_t>(y) * tile.stride, tile.width,
                out.ptr<float>(y));
  return out;
}

/// Gives points of the ring the depth of the nearest point inside.
void extend(cv::Mat1f& depth, const cv::Mat1b& inside, const cv::Mat1b& ring) {
  cv::Mat1b outside;
  cv::bitwise_not(inside, outside);
  cv::Mat distance;
  cv::Mat1i label;
  cv::distanceTransform(outside, distance, label, cv::DIST_L2, cv::DIST_MASK_5,
                        cv::DIST_LABEL_PIXEL);
  std::vector<float> of_label(static_cast<std::size_t>(inside.total()) + 1, 0.0f);
  for (int y = 0; y < inside.rows; ++y)
    for (int x = 0; x < inside.cols; ++x)
      if (inside(y, x)) of_label[static_cast<std::size_t>(label(y, x))] = depth(y, x);
  for (int y = 0; y < inside.rows; ++y)
    for (int x = 0; x < inside.cols; ++x)
      if (ring(y, x)) depth(y, x) = of_label[static_cast<std::size_t>(label(y, x))];
}

/// Returns the points along a side of a model's grid. A model that is larger than kCovered
/// has more, so that its parts are sampled as finely.
int grid_for(const Mesh& mesh) {
  constexpr float kCovered = 0.35f;  // metres that kSampleGrid points cover
  constexpr int kMostTimes = 3;
  const float size =
      (mesh.vertices.rowwise().maxCoeff() - mesh.vertices.rowwise().minCoeff()).norm();
  return kSampleGrid * std::clamp(static_cast<int>(std::ceil(size / kCovered)), 1, kMostTimes);
}

}  // namespace

struct SurfaceSampler::Impl {
  Impl(const Scene& whole_scene, std::size_t model, const std::vector<Camera>& cameras)
      : scene(whole_scene),
        item(whole_scene.items()[model]),
        single(std::vector{std::pair{item.name, item.model}}),
        grid_size(grid_for(item.model->data().mesh)),
        tiles(single, cameras, {grid_size, kSamplePadding}),
        single_plan(single, ScenePlan::Surface::simplified),
        single_drawer(single_plan),
        surface(spread_points(item.model->data().mesh, kPoints)),
        posed_surface(surface) {
    if (!item.model->poses_itself()) corners = take_corners(item.model->data().mesh, posed_surface);
    if (scene.items().size() == 1) return;
    whole_plan = std::make_unique<ScenePlan>(scene, ScenePlan::Surface::simplified);
    whole_drawer = std::make_unique<HypothesisDrawer>(*whole_plan);
  }

  /// Draws into the views' grids the model alone and the whole scene.
  void draw(const Observation& header, const Eigen::VectorXd& state, const Eigen::VectorXd& own);
  /// Returns where a view shows the model, and the ring around it, before any colour is known.
  SampledView silhouette(std::size_t view) const;
  // These take a band of rows, as several threads do.
  void look_up(const Lookup& lookup, std::size_t view, const cv::Range& rows,
               SampledView& out) const;
  void pair(const Lookup& other, const StereoMap& map, const cv::Mat1f& depth,
            const cv::Range& rows, SurfaceSamples& out) const;
  std::vector<SurfaceSamples::Point> points(const SampledView& view, const TileCamera& grid,
                                            const Eigen::VectorXd& part) const;

  const Scene& scene;
  const Scene::Item& item;
  Scene single;
  int grid_size;
  TileMaker tiles;
  ScenePlan single_plan;
  HypothesisDrawer single_drawer;
  SurfacePoints surface;
  SurfacePoints posed_surface;  // with corners of the mesh that is posed
  Mesh corners;                 // that mesh, unless the model poses itself
  std::unique_ptr<ScenePlan> whole_plan;
  std::unique_ptr<HypothesisDrawer> whole_drawer;
  FrameProjection projection;
  std::array<cv::Mat1f, 2> own, all;  // drawn 1/z
  std::shared_ptr<const HiddenViews> hidden;
  std::array<cv::Mat1b, 2> behind;  // hidden pixels; empty: none
};

SurfaceSampler::SurfaceSampler(const Scene& scene, std::size_t model,
                               const std::vector<Camera>& cameras)
    : impl_(std::make_unique<Impl>(scene, model, cameras)) {}
SurfaceSampler::~SurfaceSampler() = default;
SurfaceSampler::SurfaceSampler(SurfaceSampler&&) noexcept = default;

void SurfaceSampler::hide(std::shared_ptr<const HiddenViews> hidden) {
  impl_->hidden = std::move(hidden);
}

const SurfacePoints& SurfaceSampler::points() const { return impl_->surface; }

void SurfaceSampler::Impl::draw(const Observation& header, const Eigen::VectorXd& state,
                                const Eigen::VectorXd& part) {
  projection = FrameProjection(header);
  single_drawer.prepare(projection);
  const auto drawn = single_drawer.draw({part.data(), static_cast<std::size_t>(part.size())});
  for (std::size_t i = 0; i < 2; ++i) own[i] = inverse_depths(drawn[i]);
  all = own;
  if (!whole_drawer) return;
  whole_drawer->prepare(projection);
  const auto everything =
      whole_drawer->draw({state.data(), static_cast<std::size_t>(state.size())});
  for (std::size_t i = 0; i < 2; ++i) all[i] = inverse_depths(everything[i]);
}

SampledView SurfaceSampler::Impl::silhouette(std::size_t view) const {
  SampledView out{cv::Mat3f(grid_size, grid_size, cv::Vec3f(0, 0, 0)),
                  cv::Mat1b(grid_size, grid_size, uchar{0}),
                  {}};
  const cv::Mat1f &mine = own[view], &nearest = all[view];
  for (int y = 0; y < grid_size; ++y)
    for (int x = 0; x < grid_size; ++x)
      if (mine(y, x) > 0 && scalar::same_depth(mine(y, x), nearest(y, x), kSameSurface))
        out.inside(y, x) = 255;
  const cv::Mat ball = cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * kRing + 1, 2 * kRing + 1});
  cv::dilate(out.inside, out.ring, ball);
  return out;
}

void SurfaceSampler::Impl::look_up(const Lookup& lookup, std::size_t view, const cv::Range& rows,
                                   SampledView& out) const {
  const bool is_partly_hidden = !behind[view].empty();
  for (int y = rows.start; y < rows.end; ++y)
    for (int x = 0; x < grid_size; ++x) {
      if (!out.ring(y, x)) continue;
      bool seen = lookup(static_cast<float>(x), static_cast<float>(y), out.color(y, x));
      seen = seen && !(is_partly_hidden && behind[view](y, x));
      if (!seen) out.inside(y, x) = 0;
      if (!seen || all[view](y, x) > 0) out.ring(y, x) = 0;
    }
}

void SurfaceSampler::Impl::pair(const Lookup& other, const StereoMap& map, const cv::Mat1f& depth,
                                const cv::Range& rows, SurfaceSamples& out) const {
  const auto grid_point = [&](float at) {
    return std::clamp(static_cast<int>(pixel::round(at)), 0, grid_size - 1);
  };
  const SampledView& first = out.views[0];
  for (int y = rows.start; y < rows.end; ++y)
    for (int x = 0; x < grid_size; ++x) {
      const float w = depth(y, x);
      if (!(first.inside(y, x) || first.ring(y, x)) || !(w > 0)) continue;
      const auto fx = static_cast<float>(x), fy = static_cast<float>(y);
      const scalar::Mapped<float> at = map.rectified ? scalar::map_pixel<true>(map, fx, fy, w)
                                                     : scalar::map_pixel<false>(map, fx, fy, w);
      if (!scalar::lands_inside<false>(map, at)) continue;
      if (!behind[1].empty() && behind[1](grid_point(at.v), grid_point(at.u))) continue;
      if (first.inside(y, x)) {
        const int column = grid_point(at.u), row = grid_point(at.v);
        if (!scalar::same_depth(at.inverse_depth, all[1](row, column), 2 * kSameSurface)) continue;
      }
      if (other(at.u, at.v, out.other(y, x))) out.paired(y, x) = 255;
    }
}

std::vector<SurfaceSamples::Point> SurfaceSampler::Impl::points(const SampledView& view,
                                                                const TileCamera& grid,
                                                                const Eigen::VectorXd& part) const {
  const Eigen::Matrix3Xf vertices =
      posed_vertices(*item.model, corners, {part.data(), static_cast<std::size_t>(part.size())});
  const Eigen::Matrix3Xd world = positions(posed_surface, vertices).cast<double>();
  std::vector<SurfaceSamples::Point> out(static_cast<std::size_t>(world.cols()));
  for (Eigen::Index i = 0; i < world.cols(); ++i) {
    const Eigen::Vector3d p = grid.camera_from_world * world.col(i);
    const cv::Point2d at(grid.fx * p.x() / p.z() + grid.cx, grid.fy * p.y() / p.z() + grid.cy);
    if (!(at.x >= 0 && at.y >= 0 && at.x < grid_size - 1 && at.y < grid_size - 1)) continue;
    const int x = cvRound(at.x), y = cvRound(at.y);
    const float w = own[0](y, x);
    SurfaceSamples::Point& point = out[static_cast<std::size_t>(i)];
    point.at = at;
    point.seen = view.inside(y, x) != 0 &&
                 scalar::same_depth(static_cast<float>(1 / p.z()), w, kSameSurface);
  }
  return out;
}

SurfaceSamples SurfaceSampler::sample(const Frame& frame, const Eigen::VectorXd& state,
                                      const ColorMap& colors) {
  Impl& self = *impl_;
  if (frame.views.size() < 2 || frame.views[0].color.empty() || frame.views[1].color.empty())
    return {};
  const Eigen::VectorXd own = state.segment(self.item.offset, self.item.model->dimension());
  SurfaceSamples out;
  out.visible = self.tiles.visible_share(own);
  if (out.visible == 0) return out;
  const TilePlan plan = self.tiles.plan(frame, own);
  self.draw(plan.header, state, own);
  for (std::size_t i = 0; i < 2; ++i)
    self.behind[i] =
        self.hidden ? self.hidden->in_tile(i, plan.header.views[i].camera) : cv::Mat1b();
  const Lookup first{self.tiles.resamplers()[0].lens(),
                     intrinsics(plan.header.views[0].camera),
                     frame.views[0].color,
                     {}};
  const Lookup second{self.tiles.resamplers()[1].lens(), intrinsics(plan.header.views[1].camera),
                      frame.views[1].color, colors};
  const TileCamera& grid = plan.header.views[0].camera;
  const int size = self.grid_size;
  const auto quarter = [&](int i) { return cv::Range(i * size / 4, (i + 1) * size / 4); };
  SampledView& left = out.views[0];
  SampledView& right = out.views[1];
  run_together({[&] { left = self.silhouette(0); }, [&] { right = self.silhouette(1); }});
  run_together({[&] { self.look_up(first, 0, quarter(0), left); },
                [&] { self.look_up(first, 0, quarter(1), left); },
                [&] { self.look_up(first, 0, quarter(2), left); },
                [&] { self.look_up(first, 0, quarter(3), left); }});
  // The longest work comes first: the others find room beside it.
  cv::Mat1f depth = self.own[0].clone();
  run_together({[&] { extend(depth, left.inside, left.ring); },
                [&] { out.points = self.points(left, grid, own); },
                [&] {
                  self.look_up(second, 1, {0, size / 2}, right);
                },
                [&] {
                  self.look_up(second, 1, {size / 2, size}, right);
                }});
  const StereoMap map = stereo_map(plan.header, 0, 1);
  out.other = cv::Mat3f(size, size, cv::Vec3f(0, 0, 0));
  out.paired = cv::Mat1b(size, size, uchar{0});
  run_together({[&] { self.pair(second, map, depth, quarter(0), out); },
                [&] { self.pair(second, map, depth, quarter(1), out); },
                [&] { self.pair(second, map, depth, quarter(2), out); },
                [&] { self.pair(second, map, depth, quarter(3), out); }});
  out.points_per_metre = grid.fx / (grid.camera_from_world * Eigen::Vector3d(own.head<3>())).z();
  const int drawn = cv::countNonZero(self.own[0]);
  const int seen = cv::countNonZero(out.views[0].inside);
  out.covered = drawn > 0 ? 1 - static_cast<double>(seen) / drawn : 1;
  return out;
}

}  // namespace hypotrack::internal
