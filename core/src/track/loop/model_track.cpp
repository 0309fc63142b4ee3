#include "track/loop/model_track.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "track/tangent.hpp"

namespace hypotrack::internal {
namespace {

// Frames after a loss in which alternative poses are searched although one looks right.
constexpr int kConfirmations = 4;

/// Returns the root mean square distance that a scene may have moved since it was last seen, in
/// metres.
double sigma_after(double seconds) {
  constexpr double kAtOnce = 0.03, kPerSecond = 0.3;
  return kAtOnce + kPerSecond * std::max(seconds, 0.0);
}

/// Returns how far a landmark may have moved against the rest of its model since something hides
/// it, in metres.
double sigma_behind(double seconds) {
  constexpr double kAtOnce = 0.005, kPerSecond = 0.1, kMost = 0.08;
  return std::min(kAtOnce + kPerSecond * std::max(seconds, 0.0), kMost);
}

}  // namespace

ModelTrack::ModelTrack(const Scene& scene, std::size_t model, Eigen::Index first_landmark,
                       const Eigen::VectorXd& start, bool is_given, const StatusSettings& settings)
    : scene_(scene),
      model_(model),
      first_landmark_(first_landmark),
      landmarks_(std::ssize(scene.items()[model].model->data().landmarks)),
      monitor_(settings),
      phase_(is_given ? Phase::awaited : Phase::sought) {
  if (!is_given) monitor_.expect_no_start();
  const Scene::Item& item = scene.items()[model];
  kept_ = start.segment(item.offset, item.model->dimension());
}

Status ModelTrack::judge(const StatusMeasures& measures) {
  const Status status = monitor_.judge(measures);
  confirmed_ = measures.confirmed;
  detected_ = measures.detected;
  rests_ = false;
  move(event_of(status));
  return status;
}

void ModelTrack::take(bool is_right, const Eigen::VectorXd& state, const Eigen::VectorXd& velocity,
                      double time) {
  confirmations_ = is_right ? std::max(0, confirmations_ - 1) : kConfirmations;
  if (!is_right) return;
  searches_ = 0;
  const Scene::Item& item = scene_.items()[model_];
  kept_ = state.segment(item.offset, kept_.size());
  kept_time_ = time;
  velocity_.resize(0);
  if (velocity.size() == 0) return;
  const auto before =
      static_cast<Eigen::Index>(model_);  // a difference is shorter by one per model
  velocity_ = velocity.segment(item.offset - before, kept_.size() - 1);
}

void ModelTrack::leave_start() {
  monitor_.distrust_start();
  move(PhaseEvent::forgotten);
}

void ModelTrack::forget() {
  contradictions_ = 0;
  move(PhaseEvent::forgotten);
}

void ModelTrack::restart() {
  searches_ = 0;
  contradictions_ = 0;
  confirmations_ = kConfirmations;
  velocity_.resize(0);
  move(PhaseEvent::restarted);
}

void ModelTrack::write_kept(Eigen::VectorXd& state) const {
  state.segment(scene_.items()[model_].offset, kept_.size()) = kept_;
}

void ModelTrack::extrapolate(double time, Eigen::VectorXd& state) const {
  constexpr double kSlowing = 0.1;  // time constant, in seconds, with which unseen motion fades
  write_kept(state);
  if (velocity_.size() == 0) return;
  const double seconds = kSlowing * (1 - std::exp(-std::max(time - kept_time_, 0.0) / kSlowing));
  const Eigen::Index offset = scene_.items()[model_].offset;
  const auto before = static_cast<Eigen::Index>(model_);
  Eigen::VectorXd motion =
      Eigen::VectorXd::Zero(scene_.dimension() - static_cast<Eigen::Index>(scene_.items().size()));
  motion.segment(offset - before, velocity_.size()) = velocity_ * seconds;
  state.segment(offset, kept_.size()) = moved(scene_, state, motion).segment(offset, kept_.size());
}

double ModelTrack::seconds_since_right(double time) const {
  if (is_unknown(phase_)) return std::numeric_limits<double>::infinity();
  return std::max(time - kept_time_, 1e-3);
}

bool ModelTrack::take_check(bool is_elsewhere) {
  constexpr int kMost = 2;
  contradictions_ = is_elsewhere ? contradictions_ + 1 : 0;
  return contradictions_ >= kMost;
}

bool ModelTrack::is_time_to_search_all(bool is_detectable) {
  constexpr unsigned kSecond = 4;
  const unsigned count = ++searches_;
  // A model that no detector sees at first has hardly come yet.
  if (count == kSecond && is_detectable && is_unknown(phase_)) return false;
  return std::has_single_bit(count) && std::countr_zero(count) % 2 == 0;
}

double ModelTrack::mean_sigma(const Eigen::VectorXd& of_scene) const {
  if (of_scene.size() == 0 || landmarks_ == 0) return std::numeric_limits<double>::quiet_NaN();
  return of_scene.segment(first_landmark_, landmarks_).mean();
}

void ModelTrack::widen(double time, Eigen::VectorXd& of_scene) const {
  if (of_scene.size() == 0 || has_pose(phase_)) return;
  const double wider = sigma_after(time - kept_time_);
  for (double& sigma : of_scene.segment(first_landmark_, landmarks_))
    if (!(sigma > wider)) sigma = wider;
}

bool ModelTrack::widen_hidden(const std::vector<bool>& hidden, bool is_right, double time,
                              double most, Eigen::VectorXd& of_scene) {
  if (shown_times_.size() == 0) shown_times_.setConstant(landmarks_, time);
  double sum = 0;
  for (Eigen::Index i = 0; i < landmarks_; ++i) {
    const Eigen::Index of_all = first_landmark_ + i;
    if (hidden.empty() || !hidden[static_cast<std::size_t>(of_all)]) {
      if (is_right) shown_times_[i] = time;
      continue;
    }
    const double wider = sigma_behind(time - shown_times_[i]);
    sum += wider;
    if (of_scene.size() > 0) of_scene[of_all] = std::max(of_scene[of_all], wider);
  }
  return sum > most * static_cast<double>(landmarks_);
}

}  // namespace hypotrack::internal
