#include "output/metrics/metrics.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace hypotrack::internal {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kMmPerMetre = 1000;

}  // namespace

FrameError MetricsCollector::add(int frame, double time, const FrameStatuses& statuses,
                                 const Eigen::Matrix3Xd& estimate, const Eigen::Matrix3Xd& truth,
                                 const std::vector<bool>& absent, const Eigen::VectorXd& sigma) {
  const int frames_before = counts_.frames++;
  if (frames_before == 0) first_time_ = time;
  const bool missing = statuses.frame == FrameStatus::missing;
  counts_.missing_frames += missing;
  FrameError error = frame_error(layout_, estimate, missing ? Eigen::Matrix3Xd() : truth);
  const double mean_mm = kMmPerMetre * error.mean;
  const std::vector<StatusCollector::ModelStatus> models =
      model_statuses(statuses, error, truth, absent, sigma);
  status_.add(statuses.frame, models);
  const bool said_lost = std::ranges::any_of(models, [](const StatusCollector::ModelStatus& m) {
    return (m.status == FrameStatus::lost && !m.absent) ||
           (m.status == FrameStatus::absent && m.in_view);
  });
  if (said_lost || mean_mm > kLostErrorMm) {
    if (counts_.lost_frames++ == 0) {
      counts_.frames_to_loss = frames_before;
      counts_.time_to_loss_s = time - first_time_;
    }
  }
  if (std::isnan(error.mean)) return error;
  errors_mm_.push_back(mean_mm);
  model_errors_mm_.resize(layout_.models.size());
  for (std::size_t i = 0; i < error.models.size(); ++i)
    if (!std::isnan(error.models[i])) model_errors_mm_[i].push_back(kMmPerMetre * error.models[i]);
  if (landmark_sums_mm_.size() == 0)
    landmark_sums_mm_ = landmark_counts_ = Eigen::VectorXd::Zero(error.landmarks.size());
  const auto known = error.landmarks.array().isNaN() == false;
  landmark_sums_mm_.array() += known.select(kMmPerMetre * error.landmarks.array(), 0.0);
  landmark_counts_.array() += known.cast<double>();
  add_jitter(frame, kMmPerMetre * (estimate - truth));
  return error;
}

std::vector<StatusCollector::ModelStatus> MetricsCollector::model_statuses(
    const FrameStatuses& statuses, const FrameError& error, const Eigen::Matrix3Xd& truth,
    const std::vector<bool>& absent, const Eigen::VectorXd& sigma) const {
  std::vector<StatusCollector::ModelStatus> out(layout_.models.size());
  const std::vector<double> sigmas =
      sigma.size() > 0 ? model_means(layout_, sigma) : std::vector<double>(out.size(), kNan);
  for (std::size_t m = 0; m < out.size(); ++m)
    out[m] = {.status = statuses.models.empty() ? statuses.frame : statuses.models[m],
              .error_mm = error.models.empty() ? kNan : kMmPerMetre * error.models[m],
              .absent = !absent.empty() && absent[m],
              .sigma_mm = kMmPerMetre * sigmas[m]};
  for (Eigen::Index i = 0; i < truth.cols(); ++i) {
    auto& model = out[layout_.model_of[static_cast<std::size_t>(i)]];
    model.in_view = model.in_view || !truth.col(i).array().isNaN().all();
  }
  return out;
}

void MetricsCollector::add_jitter(int frame, const Eigen::Matrix3Xd& vectors) {
  if (last_.size() == 2 && last_[0].frame == frame - 2 && last_[1].frame == frame - 1) {
    const Eigen::VectorXd turn =
        (vectors - 2 * last_[1].vectors + last_[0].vectors).colwise().norm();
    const double of_frame = mean(without_nan(model_means(layout_, turn)));
    if (!std::isnan(of_frame)) jitter_mm_.push_back(of_frame);
  }
  if (last_.size() == 2) last_.erase(last_.begin());
  last_.push_back({frame, vectors});
}

Metrics MetricsCollector::metrics() const {
  Metrics m = counts_;
  const std::vector<double>& errors = errors_mm_;
  m.evaluated_frames = static_cast<int>(errors.size());
  m.mean_error_mm = mean(errors);
  m.sd_error_mm = standard_deviation(errors);
  m.median_error_mm = percentile(errors, 0.5);
  m.p75_error_mm = percentile(errors, 0.75);
  m.p90_error_mm = percentile(errors, 0.9);
  m.p95_error_mm = percentile(errors, 0.95);
  m.max_error_mm = percentile(errors, 1);
  m.auc_20_50 = area_under_success(errors, kAucLowMm, kAucHighMm);
  for (std::size_t i = 0; i < m.success.size(); ++i)
    m.success[i] = share_below(errors, kSuccessThresholdsMm[i]);
  m.success_curve = success_curve(errors);
  const int with_solution = m.frames - m.missing_frames;
  m.lost_share = with_solution == 0 ? kNan : static_cast<double>(m.lost_frames) / with_solution;
  if (!m.frames_to_loss) m.time_to_loss_s = kNan;
  m.jitter_mm = mean(jitter_mm_);
  m.status = status_.metrics();
  for (std::size_t i = 0; i < layout_.models.size(); ++i)
    m.models.emplace_back(layout_.models[i],
                          i < model_errors_mm_.size() ? mean(model_errors_mm_[i]) : kNan);
  for (std::size_t i = 0; i < layout_.names.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const bool known = at < landmark_counts_.size() && landmark_counts_[at] > 0;
    m.landmarks.emplace_back(layout_.names[i],
                             known ? landmark_sums_mm_[at] / landmark_counts_[at] : kNan);
  }
  return m;
}

}  // namespace hypotrack::internal
