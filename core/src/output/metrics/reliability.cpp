#include "output/metrics/reliability.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hypotrack::internal {
namespace {

constexpr double kFirstEnd = 0.0005;  // metres

std::size_t bin_of(double sigma) {
  if (sigma < kFirstEnd) return 0;
  const auto bin = static_cast<std::size_t>(std::log2(sigma / kFirstEnd)) + 1;
  return std::min(bin, Reliability::kBins - 1);
}

}  // namespace

void Reliability::add(const Eigen::VectorXd& sigma, const Eigen::VectorXd& error) {
  for (Eigen::Index i = 0; i < std::min(sigma.size(), error.size()); ++i) {
    if (!std::isfinite(sigma[i]) || !std::isfinite(error[i]) || sigma[i] <= 0) continue;
    for (Sums* sums : {&sums_[bin_of(sigma[i])], &all_}) {
      ++sums->count;
      sums->sigma += sigma[i] * sigma[i];
      sums->error += error[i] * error[i];
    }
    const double ratio = error[i] / sigma[i];
    ratio_ += ratio * ratio;
    for (std::size_t k = 0; k < within_.size(); ++k)
      within_[k] += ratio < static_cast<double>(k + 1);
  }
}

std::array<ReliabilityBin, Reliability::kBins> Reliability::bins() const {
  std::array<ReliabilityBin, kBins> bins;
  double low = 0, high = kFirstEnd;
  for (std::size_t i = 0; i < kBins; ++i) {
    const auto count = static_cast<double>(sums_[i].count);
    const bool last = i + 1 == kBins;
    bins[i] = {low, last ? std::numeric_limits<double>::infinity() : high, sums_[i].count,
               std::sqrt(sums_[i].sigma / count), std::sqrt(sums_[i].error / count)};
    low = high;
    high *= 2;
  }
  return bins;
}

double Reliability::error_over_sigma() const {
  return std::sqrt(ratio_ / static_cast<double>(all_.count));
}

double Reliability::within(int sigmas) const {
  return all_.count > 0 ? static_cast<double>(within_.at(static_cast<std::size_t>(sigmas - 1))) /
                              static_cast<double>(all_.count)
                        : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace hypotrack::internal
