#include "sight_term.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "hypotrack/plugin/kinematics.hpp"

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

/// Returns the derivatives of residual() by the landmark's position.
Eigen::Matrix<double, 2, 3> slopes(const Sight& sight, const Deviation& deviation,
                                   const Eigen::Vector3d& landmark) {
  using Slopes = Eigen::Matrix<double, 2, 3>;
  const Eigen::Vector3d to = landmark - sight.eye;
  const double distance = to.norm();
  const Eigen::Vector3d direction = to / distance;
  const double forward = direction.dot(sight.along);
  const Eigen::Vector3d u = sight.along.unitOrthogonal();
  Slopes sides;
  sides << u.transpose(), sight.along.cross(u).transpose();
  const double k = 2 * sight.distance / (1 + forward);
  const Eigen::Vector2d off = k * sides * direction;
  const double length = off.norm();
  const double scaled = (length - deviation.free) / deviation.sigma;
  if (!(scaled > 0) || !std::isfinite(k)) return Slopes::Zero();
  const Eigen::Matrix3d turn =
      (Eigen::Matrix3d::Identity() - direction * direction.transpose()) / distance;
  const Slopes move = k * sides * turn - off * (sight.along.transpose() * turn) / (1 + forward);
  // The residual is f(length) * off / length, f(length) = factor * scaled / hypot(1, scaled).
  const double root = std::hypot(1, scaled);
  const double f = sight.factor * scaled / root;
  const double f_slope = sight.factor / (deviation.sigma * root * root * root);
  const Eigen::RowVector3d lengthen = off.transpose() * move / length;
  return f / length * move + (f_slope - f / length) / length * off * lengthen;
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

void write_jacobian(std::span<const HandSights> hands, const Deviation& deviation,
                    std::span<const double> state, Jacobian& jacobian) {
  Eigen::Index at = 0;
  for (const HandSights& hand : hands) {
    const Eigen::Index rows = 2 * std::ssize(hand.sights);
    if (sees_nothing(hand)) {
      at += rows;
      continue;
    }
    const Eigen::Index dimension = hand.model->dimension();
    const auto part =
        state.subspan(static_cast<std::size_t>(hand.offset), static_cast<std::size_t>(dimension));
    const Eigen::Matrix3Xd landmarks = posed_landmarks(*hand.model, part);
    const Eigen::MatrixXd derivatives = landmark_derivatives(*hand.model, part);
    for (const Sight& sight : hand.sights) {
      if (sight.factor != 0) {
        jacobian.block(at, hand.offset, 2, dimension) =
            (slopes(sight, deviation, landmarks.col(sight.landmark)) *
             derivatives.middleRows<3>(3 * sight.landmark))
                .cast<float>();
      }
      at += 2;
    }
  }
}

}  // namespace hypotrack::landmarks
