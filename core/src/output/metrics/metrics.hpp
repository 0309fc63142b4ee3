#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/exported.hpp"
#include "base/statistics.hpp"
#include "output/metrics/frame_outcome.hpp"
#include "output/metrics/landmark_errors.hpp"
#include "output/metrics/status_metrics.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

inline constexpr double kLostErrorMm = 40;
inline constexpr double kAucLowMm = 20;
inline constexpr double kAucHighMm = 50;
inline constexpr std::array<int, 6> kSuccessThresholdsMm{5, 10, 20, 30, 40, 50};

/// Metrics of a sequence of solutions; docs/reference/metrics.md defines every number. NaN:
/// unknown, because no frame has the data for it.
struct Metrics {
  int frames = 0;
  int evaluated_frames = 0;  ///< frames with an error
  int missing_frames = 0;
  double mean_error_mm = 0;
  double sd_error_mm = 0;
  double median_error_mm = 0;
  double p75_error_mm = 0;
  double p90_error_mm = 0;
  double p95_error_mm = 0;
  double max_error_mm = 0;
  double auc_20_50 = 0;
  std::array<double, kSuccessThresholdsMm.size()> success{};  ///< share below each threshold
  int lost_frames = 0;
  double lost_share = 0;  ///< of the frames that are not missing
  std::optional<int> frames_to_loss;
  double time_to_loss_s = 0;
  double jitter_mm = 0;
  OutcomeCounts outcomes;  ///< of traced frames
  StatusMetrics status;
  std::vector<std::pair<std::string, double>> models;       ///< name, mean error in mm
  std::vector<std::pair<std::string, double>> landmarks;    ///< name, mean error in mm
  std::array<double, kSuccessCurvePoints> success_curve{};  ///< share below 0, 1, ..., 100 mm
};

/// Returns the text of metrics.json: the numbers, then `models`, `landmarks` and `success_curve`.
/// NaN becomes null.
std::string to_json(const Metrics& metrics);

/// Returns the keys of the numbers in metrics.json, in their order.
std::vector<std::string> metric_names();

/// Collects Metrics frame by frame.
class MetricsCollector {
 public:
  explicit MetricsCollector(LandmarkLayout layout) : layout_(std::move(layout)) {}

  const LandmarkLayout& layout() const { return layout_; }

  /// Adds the next frame and returns its errors in metres, NaN for a missing frame. Frame numbers
  /// must ascend.
  ///
  /// `estimate` and `truth` are 3xL in metres, NaN where a landmark is unknown; `truth` is empty
  /// where nothing is known. `time` is in seconds, NaN if unknown. `absent` flags the models that
  /// the truth knows to be in no picture (empty: none). `sigma` is the tracker's uncertainty of
  /// each landmark (L, metres; empty: none).
  FrameError add(int frame, double time, const FrameStatuses& statuses,
                 const Eigen::Matrix3Xd& estimate, const Eigen::Matrix3Xd& truth,
                 const std::vector<bool>& absent = {}, const Eigen::VectorXd& sigma = {});

  /// Adds the outcome of a frame whose searches were traced.
  void add_outcome(FrameOutcome outcome) { counts_.outcomes.add(outcome); }

  Metrics metrics() const;

 private:
  /// Error vectors of a frame, estimate minus truth.
  struct Offsets {
    int frame = 0;
    Eigen::Matrix3Xd vectors;
  };
  /// Collects the data of each model for StatusCollector::add().
  std::vector<StatusCollector::ModelStatus> model_statuses(const FrameStatuses& statuses,
                                                           const FrameError& error,
                                                           const Eigen::Matrix3Xd& truth,
                                                           const std::vector<bool>& absent,
                                                           const Eigen::VectorXd& sigma) const;
  void add_jitter(int frame, const Eigen::Matrix3Xd& vectors);

  LandmarkLayout layout_;
  Metrics counts_;
  StatusCollector status_;
  double first_time_ = 0;
  std::vector<double> errors_mm_;  ///< of the frames that have one
  std::vector<std::vector<double>> model_errors_mm_;
  Eigen::VectorXd landmark_sums_mm_, landmark_counts_;
  std::vector<Offsets> last_;  ///< of up to two frames, newest last
  std::vector<double> jitter_mm_;
};

}  // namespace internal
}  // namespace hypotrack
