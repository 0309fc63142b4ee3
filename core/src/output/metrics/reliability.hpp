#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "hypotrack/export.hpp"

namespace hypotrack {

/// Landmarks whose sigma lies from `low` up to `high`. Lengths are metres.
struct ReliabilityBin {
  double low = 0, high = 0;
  std::int64_t count = 0;
  double sigma = 0, error = 0;  ///< root mean squares; NaN if there are none
};

/// Compares how far landmarks may be off, as their tracker says, with how far they are.
class HYPOTRACK_API Reliability {
 public:
  static constexpr std::size_t kBins = 9;

  /// Sigma and true error of each landmark of a frame. Pairs that are not finite are left out.
  void add(const Eigen::VectorXd& sigma, const Eigen::VectorXd& error);

  std::int64_t count() const { return all_.count; }
  /// By sigma: below 0.5 mm, then doubling, the last from 64 mm on.
  std::array<ReliabilityBin, kBins> bins() const;
  /// Root mean square of error / sigma: 1 if sigma is right on the whole; above, it promises too
  /// much. NaN without pairs.
  double error_over_sigma() const;
  /// Share of the landmarks that are off by less than `sigmas` (1, 2 or 3) of their own; NaN
  /// without pairs. An error that is normal in one direction gives 0.683, 0.954 and 0.997, alike in
  /// all three 0.608, 0.993 and 1.
  double within(int sigmas) const;

 private:
  struct Sums {
    std::int64_t count = 0;
    double sigma = 0, error = 0;  // of squares
  };
  std::array<Sums, kBins> sums_{};
  Sums all_;
  double ratio_ = 0;  // of squares
  std::array<std::int64_t, 3> within_{};
};

}  // namespace hypotrack
