#include "output/metrics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace hypotrack {

std::optional<Eigen::Matrix3Xd> true_landmarks(const Scene& scene, const Frame& frame) {
  if (!frame.truth) return std::nullopt;
  if (frame.truth->landmarks.cols() > 0) return frame.truth->landmarks;
  if (frame.truth->state.size() > 0) return scene.landmarks(frame.truth->state);
  return std::nullopt;
}

double mean_landmark_error(const Scene& scene, const Eigen::Matrix3Xd& landmarks,
                           const Eigen::Matrix3Xd& truth) {
  double sum_over_models = 0;
  int models = 0;
  Eigen::Index column = 0;
  for (const auto& item : scene.items()) {
    double sum = 0;
    int known = 0;
    for (std::size_t i = 0; i < item.model->data().landmarks.size(); ++i, ++column) {
      const double distance = (landmarks.col(column) - truth.col(column)).norm();
      if (std::isnan(distance)) continue;
      sum += distance;
      ++known;
    }
    if (known == 0) continue;
    sum_over_models += sum / known;
    ++models;
  }
  return models == 0 ? std::numeric_limits<double>::quiet_NaN() : sum_over_models / models;
}

std::optional<ErrorStatistics> error_statistics(const std::vector<double>& errors) {
  std::vector<double> mm;
  for (double e : errors)
    if (!std::isnan(e)) mm.push_back(1000 * e);
  if (mm.empty()) return std::nullopt;
  std::sort(mm.begin(), mm.end());
  const auto n = mm.size();
  ErrorStatistics s;
  s.mean = std::accumulate(mm.begin(), mm.end(), 0.0) / static_cast<double>(n);
  s.median = n % 2 == 1 ? mm[n / 2] : (mm[n / 2 - 1] + mm[n / 2]) / 2;
  for (std::size_t i = 0; i < kErrorThresholdsMm.size(); ++i)
    s.fraction_below[i] =
        static_cast<double>(std::lower_bound(mm.begin(), mm.end(), kErrorThresholdsMm[i]) -
                            mm.begin()) /
        static_cast<double>(n);
  return s;
}

}  // namespace hypotrack
