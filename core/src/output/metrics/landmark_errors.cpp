#include "output/metrics/landmark_errors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/statistics.hpp"

namespace hypotrack::internal {

LandmarkLayout landmark_layout(std::span<const std::string> names) {
  LandmarkLayout layout;
  for (const std::string& name : names) {
    const std::size_t dot = name.find('.');
    const std::string model = dot == std::string::npos ? "model" : name.substr(0, dot);
    const auto found = std::find(layout.models.begin(), layout.models.end(), model);
    layout.model_of.push_back(static_cast<std::size_t>(found - layout.models.begin()));
    if (found == layout.models.end()) layout.models.push_back(model);
    layout.names.push_back(name);
  }
  return layout;
}

std::vector<double> model_means(const LandmarkLayout& layout, const Eigen::VectorXd& values) {
  std::vector<std::vector<double>> known(layout.models.size());
  for (std::size_t i = 0; i < layout.names.size(); ++i) {
    const double value = values[static_cast<Eigen::Index>(i)];
    if (!std::isnan(value)) known[layout.model_of[i]].push_back(value);
  }
  std::vector<double> means;
  for (const auto& of_model : known) means.push_back(mean(of_model));
  return means;
}

FrameError frame_error(const LandmarkLayout& layout, const Eigen::Matrix3Xd& estimate,
                       const Eigen::Matrix3Xd& truth) {
  FrameError error;
  if (truth.cols() == 0) {
    error.landmarks.setConstant(estimate.cols(), std::numeric_limits<double>::quiet_NaN());
  } else {
    error.landmarks = (estimate - truth).colwise().norm();
  }
  error.models = model_means(layout, error.landmarks);
  error.mean = mean(without_nan(error.models));
  return error;
}

}  // namespace hypotrack::internal
