#include "track/prediction.hpp"

#include <array>

namespace hypotrack::internal {
namespace {

/// Shares of the last motion that may go on, the middle one first.
constexpr std::array kShares{0.5, 0.0, 1.0};

}  // namespace

std::span<const std::string_view> enum_names(Prediction) {
  static constexpr std::array<std::string_view, 3> names{"none", "constant", "adaptive"};
  return names;
}

Predictor::Predictor(const Scene& scene, const PredictionSettings& settings)
    : scene_(&scene), settings_(settings), parts_(tangent_parts(scene)) {}

bool Predictor::is_gap(double seconds) const {
  return !(seconds > 0 && seconds <= settings_.longest_gap);
}

Eigen::VectorXd Predictor::led(double seconds, double pose_share, double angle_share) const {
  Eigen::VectorXd motion = *velocity_ * seconds;
  for (const TangentPart& part : parts_) {
    motion.segment(part.first, part.size) *= is_joint(part.kind) ? angle_share : pose_share;
  }
  return moved(*scene_, state_, motion);
}

Eigen::MatrixXd Predictor::at(double time) const {
  const double seconds = time - time_;
  if (settings_.velocity == Prediction::none || !velocity_ || is_gap(seconds)) return {};
  if (settings_.velocity == Prediction::constant)
    return led(seconds, settings_.gain, settings_.gain);
  Eigen::MatrixXd states(state_.size(), kShares.size() * kShares.size());
  Eigen::Index column = 0;
  for (const double pose_share : kShares)
    for (const double angle_share : kShares)
      states.col(column++) = led(seconds, pose_share, angle_share);
  return states;
}

void Predictor::add(const Eigen::VectorXd& state, double time) {
  const double seconds = time - time_;
  if (state_.size() == 0 || is_gap(seconds)) {
    velocity_.reset();
  } else {
    velocity_ = difference(*scene_, state_, state) / seconds;
  }
  state_ = state;
  time_ = time;
}

}  // namespace hypotrack::internal
