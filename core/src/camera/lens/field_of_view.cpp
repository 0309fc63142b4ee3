#include "camera/lens/field_of_view.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "camera/lens/distortion.hpp"

namespace hypotrack::internal {
namespace {

/// Finds rays to edges of a picture, up to where the lens folds.
class Edges {
 public:
  explicit Edges(const Camera& camera)
      : camera_(camera), farthest_(std::min(monotonic_radius(camera), kFarthest)) {
    camera_.camera_from_world = Eigen::Isometry3d::Identity();
  }

  /// Returns the angle from the optical axis to a coordinate along an axis of the picture.
  double angle(int axis, double edge) {
    const double centre = axis == 0 ? camera_.cx : camera_.cy;
    const double side = edge < centre ? -1 : 1;
    const auto shown_at = [&](double tangent) {
      Eigen::Vector3d ray(0, 0, 1);
      ray[axis] = side * tangent;
      return side * (project(camera_, ray)[axis] - centre);
    };
    const double wanted = side * (edge - centre);
    double low = 0, high = 0;
    // Step by step: far outside the picture the terms of a lens may turn rays back.
    for (double angle = kStep; shown_at(high) < wanted; angle += kStep) {
      low = std::exchange(high, std::min(std::tan(angle), farthest_));
      if (high < farthest_ && shown_at(high) > shown_at(low)) continue;
      if (shown_at(high) >= wanted) break;
      reached_ = false;
      if (shown_at(high) > shown_at(low)) low = high;
      high = low;
      break;
    }
    constexpr int kHalvings = 60;
    for (int i = 0; i < kHalvings && low < high; ++i) {
      const double middle = std::midpoint(low, high);
      (shown_at(middle) < wanted ? low : high) = middle;
    }
    return side * std::atan(low);
  }

  bool reached() const { return reached_; }

 private:
  static constexpr double kFarthest = 256;    // 89.8 degrees
  static constexpr double kStep = 1.0 / 256;  // radians

  Camera camera_;
  double farthest_;
  bool reached_ = true;
};

}  // namespace

FieldOfView field_of_view(const Camera& camera) {
  Edges edges(camera);
  FieldOfView out;
  out.horizontal = edges.angle(0, camera.width - 0.5) - edges.angle(0, -0.5);
  out.vertical = edges.angle(1, camera.height - 0.5) - edges.angle(1, -0.5);
  out.reaches_edges = edges.reached();
  return out;
}

}  // namespace hypotrack::internal
