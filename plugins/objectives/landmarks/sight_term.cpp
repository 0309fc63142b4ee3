#include "sight_term.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "hypotrack/kinematics.hpp"

namespace hypotrack::landmarks {
namespace {

/// Returns by how much a landmark is off its line of sight: metres across it, in the world, of a
/// stereographic projection. It grows up to right behind the eye.
Eigen::Vector3d across(const Sight& sight, const Eigen::Vector3d& landmark) {
  constexpr double kNearest = 1e-9;
  const Eigen::Vector3d to = landmark - sight.eye;
  const Eigen::Vector3d direction = to / std::max(to.norm(), kNearest);
  const double forward = direction.dot(sight.along);
  return sight.distance * 2 / std::max(1 + forward, kNearest) * (direction - forward * sight.along);
}

/// Returns two numbers whose squares sum to the cost of a landmark.
Eigen::Vector2d residual(const Sight& sight, const Deviation& deviation,
                         const Eigen::Vector3d& landmark) {
  const Eigen::Vector3d off = across(sight, landmark);
  const double length = off.norm();
  const double scaled = (length - deviation.free) / deviation.sigma;
  if (!(scaled > 0)) return Eigen::Vector2d::Zero();
  const Eigen::Vector3d u = sight.along.unitOrthogonal();
  const Eigen::Vector2d direction(off.dot(u) / length, off.dot(sight.along.cross(u)) / length);
  return sight.factor * scaled / std::hypot(1, scaled) * direction;
}

bool sees_nothing(const HandSights& hand) {
  return std::ranges::all_of(hand.sights, [](const Sight& s) { return s.factor == 0; });
}

}  // namespace

std::int64_t residual_count(std::span<const HandSights> hands) {
  std::int64_t count = 0;
  for (const HandSights& hand : hands) count += 2 * static_cast<std::int64_t>(hand.sights.size());
  return count;
}

double cost_and_residuals(std::span<const HandSights> hands, const Deviation& deviation,
                          std::span<const double> state, std::span<float> residuals) {
  std::ranges::fill(residuals, 0.0f);
  double cost = 0;
  std::size_t at = 0;
  for (const HandSights& hand : hands) {
    if (sees_nothing(hand)) {
      at += 2 * hand.sights.size();
      continue;
    }
    const Eigen::Matrix3Xd landmarks = posed_landmarks(
        *hand.model, state.subspan(static_cast<std::size_t>(hand.offset),
                                   static_cast<std::size_t>(hand.model->dimension())));
    for (const Sight& sight : hand.sights) {
      if (sight.factor != 0) {
        const Eigen::Vector2d r = residual(sight, deviation, landmarks.col(sight.landmark));
        cost += r.squaredNorm();
        if (!residuals.empty()) {
          residuals[at] = static_cast<float>(r.x());
          residuals[at + 1] = static_cast<float>(r.y());
        }
      }
      at += 2;
    }
  }
  return cost;
}

}  // namespace hypotrack::landmarks
