#include "tile/foreground_overlap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace hypotrack::internal {
namespace {

/// A view with a mask.
struct Masked {
  const Camera& camera;
  const cv::Mat& mask;

  bool has(const Eigen::Vector3d& p_world) const {
    const Eigen::Vector2d p = project(camera, p_world);
    if (!(p.x() > -0.5 && p.x() < mask.cols - 0.5 && p.y() > -0.5 && p.y() < mask.rows - 0.5))
      return false;
    return mask.at<std::uint8_t>(static_cast<int>(std::lround(p.y())),
                                 static_cast<int>(std::lround(p.x()))) != 0;
  }
};

/// Returns twice the signed area of a triangle.
double area(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// Calls `use` with a point of the triangle at each foreground pixel that it covers. Stops and
/// returns true when `use` does.
template <class Use>
bool any_point(const std::array<Eigen::Vector3d, 3>& corners, const Masked& view, const Use& use) {
  std::array<Eigen::Vector2d, 3> t;
  for (std::size_t k = 0; k < 3; ++k) t[k] = project(view.camera, corners[k]);
  const Eigen::Vector2d low = t[0].cwiseMin(t[1]).cwiseMin(t[2]);
  const Eigen::Vector2d high = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
  const double whole = area(t[0], t[1], t[2]);
  if (!low.allFinite() || !high.allFinite() || whole == 0) return false;
  const auto first = [](double value, int end) {
    return static_cast<int>(std::ceil(std::clamp(value, 0.0, static_cast<double>(end))));
  };
  const auto last = [](double value, int end) {
    return static_cast<int>(std::floor(std::clamp(value, -1.0, end - 1.0)));
  };
  for (int y = first(low.y(), view.mask.rows); y <= last(high.y(), view.mask.rows); ++y) {
    const auto* row = view.mask.ptr<std::uint8_t>(y);
    for (int x = first(low.x(), view.mask.cols); x <= last(high.x(), view.mask.cols); ++x) {
      if (!row[x]) continue;
      const Eigen::Vector2d p(x, y);
      const double a = area(p, t[1], t[2]) / whole, b = area(t[0], p, t[2]) / whole;
      if (a < 0 || b < 0 || a + b > 1) continue;
      if (use(a * corners[0] + b * corners[1] + (1 - a - b) * corners[2])) return true;
    }
  }
  return false;
}

/// Calls `use` for all triangles of a scene; stops and returns true when `use` does.
template <class Use>
bool any_point(const PosedScene& scene, const Eigen::Isometry3d& world_from_scene,
               const Masked& view, const Use& use) {
  const ScenePlan& plan = scene.plan();
  const ScenePoser& vertices = scene.vertices();
  for (std::size_t t = 0; t < plan.triangle_count; ++t) {
    std::array<Eigen::Vector3d, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t v = plan.corners[4 * t + k] / kRecord;
      corners[k] =
          world_from_scene * Eigen::Vector3d(vertices.x()[v], vertices.y()[v], vertices.z()[v]);
    }
    if (any_point(corners, view, use)) return true;
  }
  return false;
}

}  // namespace

ForegroundOverlap foreground_overlap(const PosedScene& scene,
                                     const Eigen::Isometry3d& world_from_scene,
                                     std::span<const Camera> cameras, std::span<const View> views) {
  std::vector<Masked> masked;
  for (std::size_t i = 0; i < views.size(); ++i)
    if (!views[i].mask.empty()) masked.push_back({cameras[i], views[i].mask});
  if (masked.empty()) return ForegroundOverlap::unknown;
  bool covers = false;
  const auto in_all = [&](const Eigen::Vector3d& point) {
    covers = true;
    return std::all_of(masked.begin() + 1, masked.end(),
                       [&](const Masked& view) { return view.has(point); });
  };
  if (any_point(scene, world_from_scene, masked.front(), in_all)) return ForegroundOverlap::yes;
  for (std::size_t i = 1; i < masked.size() && !covers; ++i)
    covers = any_point(scene, world_from_scene, masked[i], [](const auto&) { return true; });
  return covers ? ForegroundOverlap::in_parts : ForegroundOverlap::nowhere;
}

}  // namespace hypotrack::internal
