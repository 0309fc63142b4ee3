#include "model_contours.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <string>
#include <utility>

#include "cache_file.hpp"
#include "hypotrack/api/renderer.hpp"
#include "silhouette_edges.hpp"

namespace hypotrack::contour {
namespace {

constexpr int kReach = 5;          // pixels along the outline, each side, that give its direction
constexpr float kStraight = 0.9f;  // pixels off a line that quantisation explains

/// A straight piece of outline in pixels.
struct Piece {
  Eigen::Vector2f position;
  Eigen::Vector2f normal;  ///< unit, outwards
};

Eigen::Vector2f vector(const cv::Point& p) {
  return {static_cast<float>(p.x), static_cast<float>(p.y)};
}

/// Returns how many pixels from `from` along `step` are on the model, or are not; infinite up to
/// the edge of the picture.
float length(const cv::Mat1b& mask, Eigen::Vector2f from, const Eigen::Vector2f& step, bool on) {
  for (float out = 0;; ++out, from += step) {
    const int x = static_cast<int>(std::lround(from.x())),
              y = static_cast<int>(std::lround(from.y()));
    if (x < 0 || y < 0 || x >= mask.cols || y >= mask.rows)
      return on ? out : std::numeric_limits<float>::infinity();
    if ((mask(y, x) != 0) != on) return out;
  }
}

/// Returns the piece about pixel i of a closed chain of the mask's border pixels. Nothing at a
/// corner.
std::optional<Piece> piece(const cv::Mat1b& mask, const std::vector<cv::Point>& chain, int i) {
  const int size = static_cast<int>(chain.size());
  if (size <= 2 * kReach) return std::nullopt;  // a speck or a pinhole
  const auto at = [&](int k) { return vector(chain[static_cast<std::size_t>((k + size) % size)]); };
  const Eigen::Vector2f along = at(i + kReach) - at(i - kReach);
  if (!(along.norm() > kReach)) return std::nullopt;
  Piece out;
  out.normal = Eigen::Vector2f(along.y(), -along.x()).normalized();
  const Eigen::Vector2f here = at(i);
  float sum = 0, low = 0, high = 0;
  for (int k = i - kReach; k <= i + kReach; ++k) {
    const float off = out.normal.dot(at(k) - here);
    sum += off;
    low = std::min(low, off);
    high = std::max(high, off);
  }
  if (high - low > 2 * kStraight) return std::nullopt;
  const float mean = sum / (2 * kReach + 1);
  if (length(mask, here + 3 * out.normal, out.normal, true) > 0) {
    if (length(mask, here - 3 * out.normal, -out.normal, true) > 0) return std::nullopt;
    out.normal = -out.normal;
    out.position = here - mean * out.normal;
  } else {
    out.position = here + mean * out.normal;
  }
  // Centres of border pixels lie between 0 and one row or column inside the edge.
  out.position += 0.5f * out.normal.cwiseAbs().maxCoeff() * out.normal;
  return out;
}

// Distance of the drawn views in radii of the model. Outlines change little with distance beyond.
constexpr float kDistance = 5;
constexpr int kPixels = 400;      // along a side of a drawn view
constexpr double kMargin = 0.95;  // share of a view that the model may fill

/// Returns the camera at `position` that looks at `target` and just holds a ball about it.
Camera camera_at(const Eigen::Vector3f& position, const Eigen::Vector3f& target) {
  Camera camera;
  camera.width = camera.height = kPixels;
  camera.fx = camera.fy = kMargin * kPixels / 2 / std::tan(std::asin(1.0 / kDistance));
  camera.cx = camera.cy = (kPixels - 1) / 2.0;
  const Eigen::Vector3d forward = (target - position).cast<double>().normalized();
  Eigen::Matrix3d world_from_camera;
  world_from_camera.col(0) = forward.unitOrthogonal();
  world_from_camera.col(1) = forward.cross(world_from_camera.col(0));
  world_from_camera.col(2) = forward;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = world_from_camera;
  pose.translation() = position.cast<double>();
  camera.camera_from_world = pose.inverse();
  return camera;
}

/// Returns a traced point in the model's frame, on the mesh's edge if one is there.
ContourPoint lifted(const TracedPoint& traced, const Camera& camera, const SilhouetteEdges& edges) {
  const Eigen::Isometry3f model_from_camera = camera.camera_from_world.inverse().cast<float>();
  const auto f = static_cast<float>(camera.fx), c = static_cast<float>(camera.cx);
  const Eigen::Vector2f ray = (traced.position - Eigen::Vector2f(c, c)) / f;
  const Eigen::Vector2f& n = traced.normal;
  ContourPoint out{};
  out.position = model_from_camera * (traced.depth * ray.homogeneous());
  out.normal = model_from_camera.linear() * Eigen::Vector3f(n.x(), n.y(), -n.dot(ray)).normalized();
  const float metres = traced.depth / f;  // per pixel
  out.inside = metres * traced.inside;
  out.outside = metres * traced.outside;
  const std::optional<EdgePoint> edge = edges.nearest(traced.position, n);
  if (!edge) return out;
  const Eigen::Vector3f plane =
      edge->direction.cross(edge->position - model_from_camera.translation()).normalized();
  out.position = edge->position;
  out.normal = plane.dot(out.normal) < 0 ? -plane : plane;
  out.front = edge->front;
  out.back = edge->back;
  return out;
}

std::string size_of(const ContourViews& views) {
  return fmt::format("{} views, {:.1f} MB", views.directions().cols(),
                     static_cast<double>(views.points().size_bytes()) / 1e6);
}

}  // namespace

std::vector<TracedPoint> trace_contour(const cv::Mat1f& depth, int count) {
  const cv::Mat1b mask = depth > 0;
  std::vector<std::vector<cv::Point>> chains;
  cv::findContours(mask, chains, cv::RETR_CCOMP, cv::CHAIN_APPROX_NONE);
  std::size_t all = 0;
  for (const auto& chain : chains) all += chain.size();
  const double step = static_cast<double>(all) / count;
  std::vector<TracedPoint> out;
  double next = 0;
  for (const auto& chain : chains) {
    const auto size = static_cast<double>(chain.size());
    for (; next < size; next += step) {
      const int i = static_cast<int>(next);
      const std::optional<Piece> found = piece(mask, chain, i);
      if (!found) continue;
      const Eigen::Vector2f n = found->normal;
      out.push_back({found->position, n, depth(chain[static_cast<std::size_t>(i)]),
                     length(mask, found->position - n, -n, true),
                     length(mask, found->position + n, n, false)});
    }
    next -= size;
  }
  return out;
}

bool is_rigid(const Model& model) {
  return model.dimension() == kPoseSize && !model.poses_itself();
}

ContourViews draw_contours(const std::shared_ptr<const Model>& model,
                           const ViewSettings& settings) {
  const Eigen::Matrix3Xf& vertices = model->data().mesh.vertices;
  const Eigen::Vector3f centre =
      (vertices.rowwise().minCoeff() + vertices.rowwise().maxCoeff()) / 2;
  const float radius = (vertices.colwise() - centre).colwise().norm().maxCoeff();
  const Scene scene({{"model", model}});
  Renderer renderer(scene);
  SilhouetteEdges edges(model->data().mesh);
  const RenderStyle style{.textured = false, .samples = 1};
  Eigen::Matrix3Xf directions = sphere_directions(settings.subdivisions);
  std::vector<std::uint32_t> first{0};
  std::vector<ContourPoint> points;
  for (const Eigen::Vector3f direction : directions.colwise()) {
    const Camera camera = camera_at(centre + kDistance * radius * direction, centre);
    const cv::Mat1f depth = renderer.render(scene.rest_state(), camera, style).depth;
    edges.see(camera);
    for (const TracedPoint& traced : trace_contour(depth, settings.points))
      points.push_back(lifted(traced, camera, edges));
    first.push_back(static_cast<std::uint32_t>(points.size()));
  }
  return {centre, std::move(directions), std::move(first), std::move(points)};
}

ContourViews model_contours(const std::shared_ptr<const Model>& model, const Params& params,
                            const PluginLog& log) {
  const CacheFile file(params.cache, model->data().mesh, params.views);
  std::string problem;
  if (std::optional<ContourViews> kept = file.read(problem)) return std::move(*kept);
  if (!problem.empty()) log.note(problem);
  ContourViews drawn = draw_contours(model, params.views);
  problem = file.write(drawn);
  if (problem.empty())
    log.note(fmt::format("drew the outlines of a model ({}) into {}", size_of(drawn),
                         file.path().string()));
  else
    log.warning(problem);
  return drawn;
}

}  // namespace hypotrack::contour
