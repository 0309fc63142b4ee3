#include "contour_views.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace hypotrack::contour {
namespace {

using Triangle = std::array<int, 3>;

/// Returns the index of the point halfway between two corners; adds it if it is new.
class Halfway {
 public:
  explicit Halfway(std::vector<Eigen::Vector3f>& corners) : corners_(corners) {}
  int of(int a, int b) {
    const auto [place, is_new] =
        known_.try_emplace(std::minmax(a, b), static_cast<int>(corners_.size()));
    if (is_new)
      corners_.push_back(
          (corners_[static_cast<std::size_t>(a)] + corners_[static_cast<std::size_t>(b)])
              .normalized());
    return place->second;
  }

 private:
  std::vector<Eigen::Vector3f>& corners_;
  std::map<std::pair<int, int>, int> known_;
};

std::vector<Triangle> split(const std::vector<Triangle>& triangles,
                            std::vector<Eigen::Vector3f>& corners) {
  Halfway halfway(corners);
  std::vector<Triangle> out;
  for (const auto& [a, b, c] : triangles) {
    const int ab = halfway.of(a, b), bc = halfway.of(b, c), ca = halfway.of(c, a);
    out.insert(out.end(), {Triangle{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
  }
  return out;
}

}  // namespace

ContourViews::ContourViews(const Eigen::Vector3f& centre, Eigen::Matrix3Xf directions,
                           std::vector<std::uint32_t> first, std::vector<ContourPoint> points)
    : centre_(centre),
      directions_(std::move(directions)),
      by_axis_(directions_.transpose()),
      first_(std::move(first)),
      points_(std::move(points)) {
  for (const ContourPoint& point : points_)
    radius_ = std::max(radius_, (point.position - centre_).norm());
}

std::span<const ContourPoint> ContourViews::seen_by(
    const Eigen::Isometry3f& camera_from_model) const {
  const Eigen::Vector3f to_camera = camera_from_model.inverse().translation() - centre_;
  const Eigen::VectorXf cosines = by_axis_ * to_camera;
  const float highest = cosines.maxCoeff();
  const auto i = static_cast<std::size_t>(std::ranges::find(cosines, highest) - cosines.begin());
  return std::span(points_).subspan(first_[i], first_[i + 1] - first_[i]);
}

Eigen::Matrix3Xf sphere_directions(int subdivisions) {
  const float golden = (1 + std::sqrt(5.0f)) / 2;
  std::vector<Eigen::Vector3f> corners;
  for (const float one : {-1.0f, 1.0f})
    for (const float long_side : {-golden, golden})
      corners.insert(corners.end(),
                     {{one, long_side, 0}, {0, one, long_side}, {long_side, 0, one}});
  for (Eigen::Vector3f& corner : corners) corner.normalize();
  std::vector<Triangle> triangles;
  const float side = 2 / std::sqrt(1 + golden * golden);
  const auto joined = [&](int a, int b) {
    return (corners[static_cast<std::size_t>(a)] - corners[static_cast<std::size_t>(b)]).norm() <
           1.01f * side;
  };
  for (int a = 0; a < 12; ++a)
    for (int b = 0; b < a; ++b)
      for (int c = 0; c < b; ++c)
        if (joined(a, b) && joined(b, c) && joined(c, a)) triangles.push_back({a, b, c});
  for (int i = 0; i < subdivisions; ++i) triangles = split(triangles, corners);
  Eigen::Matrix3Xf out(3, static_cast<Eigen::Index>(corners.size()));
  for (std::size_t i = 0; i < corners.size(); ++i)
    out.col(static_cast<Eigen::Index>(i)) = corners[i];
  return out;
}

}  // namespace hypotrack::contour
