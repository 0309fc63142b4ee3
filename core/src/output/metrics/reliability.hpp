#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Statistics of landmarks with a sigma in [low, high). Lengths are in metres.
struct ReliabilityBin {
  double low = 0, high = 0;
  std::int64_t count = 0;
  double sigma = 0, error = 0;  ///< root mean squares; NaN if there are none
};

/// Measures the calibration of the predicted uncertainty (sigma) against the true error of
/// landmarks.
class Reliability {
 public:
  static constexpr std::size_t kBins = 9;

  /// Adds the sigma and true error of each landmark of a frame. Leaves out pairs that are not
  /// finite.
  void add(const Eigen::VectorXd& sigma, const Eigen::VectorXd& error);

  std::int64_t count() const { return all_.count; }
  /// Returns bins by sigma: below 0.5 mm, then doubling, the last from 64 mm on.
  std::array<ReliabilityBin, kBins> bins() const;
  /// Returns the root mean square of error / sigma: 1 if sigma is calibrated, above 1 if it is too
  /// small. NaN without pairs.
  double error_over_sigma() const;
  /// Returns the share of landmarks with an error below `sigmas` (1, 2 or 3) times sigma. NaN
  /// without pairs. Errors that are normal in one direction give 0.683, 0.954 and 0.997; isotropic
  /// normal errors in 3D give 0.608, 0.993 and 1.
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

}  // namespace internal
}  // namespace hypotrack
