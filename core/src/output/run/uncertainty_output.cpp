#include "output/run/uncertainty_output.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace hypotrack::internal {

void UncertaintyOutput::add(const Solution& solution, const Eigen::VectorXd& errors) {
  if (solution.sigma.size() == 0) return;
  if (!file_) {
    file_.emplace(run_->file("uncertainty.csv"));
    std::string header = "frame,time";
    for (const std::string& name : run_->scene().landmark_names()) header += "," + name;
    file_->write(header + "\n");
  }
  std::string line = fmt::format("{},{}", solution.frame, solution.time);
  for (const double sigma : solution.sigma) {
    line += fmt::format(",{:.4f}", 1000 * sigma);
    if (!std::isfinite(sigma)) continue;
    sum_ += sigma;
    ++count_;
  }
  file_->write(line + "\n");
  reliability_.add(solution.sigma, errors);
}

std::optional<double> UncertaintyOutput::mean_sigma() const {
  if (count_ == 0) return std::nullopt;
  return sum_ / static_cast<double>(count_);
}

}  // namespace hypotrack::internal
