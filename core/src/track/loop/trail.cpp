#include "track/loop/trail.hpp"

#include <utility>

namespace hypotrack::internal {

Trail::Trail(const Scene& scene, const PredictionSettings& prediction,
             const OneEuroSettings& smoothing, Eigen::VectorXd start)
    : state_(std::move(start)), predictor_(scene, prediction), output_(state_) {
  if (smoothing.enabled) smoother_.emplace(scene, smoothing);
}

Eigen::MatrixXd Trail::predicted(double time, const TileMaker& tiles, std::int64_t most) const {
  const Eigen::MatrixXd states = predictor_.at(time);
  // A tile needs a start that is in view.
  if (states.cols() == 0 || tiles.visible_share(states.col(0)) == 0) return state_;
  return states.cols() < most ? states : states.leftCols(1);
}

Eigen::VectorXd Trail::velocity() const {
  return predictor_.velocity() ? *predictor_.velocity() : Eigen::VectorXd();
}

void Trail::add(Eigen::VectorXd state, double time) {
  state_ = std::move(state);
  time_ = time;
  predictor_.add(state_, time);
}

void Trail::interrupt() {
  predictor_.forget_motion();
  if (smoother_) smoother_->begin_anew();
}

void Trail::begin_anew() {
  predictor_.begin_anew();
  if (smoother_) smoother_->begin_anew();
}

Eigen::VectorXd Trail::output(const Solution& solution) {
  if (!smoother_) return state_;
  if (solution.status != Status::missing) output_ = smoother_->filter(state_, solution.time);
  return output_;
}

}  // namespace hypotrack::internal
