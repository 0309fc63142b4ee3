#pragma once

#include <Eigen/Core>
#include <deque>
#include <vector>

#include "base/exported.hpp"
#include "track/rig/row_matches.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// How the second view of a pair differs from what its calibration and its time say.
struct RigEstimate {
  double rows = 0;   ///< pixels by which it is lower at the principal point
  double roll = 0;   ///< radians, clockwise
  double scale = 0;  ///< share by which it is larger
  double delay = 0;  ///< seconds by which it is late

  double row_error = 0;        ///< root mean square of the rows at the matches, pixels
  double row_error_sigma = 0;  ///< its standard deviation
  double delay_sigma = 0;      ///< seconds
  int matches = 0;
};

/// Fits rows = rows + roll x + scale y - delay v to the residuals of matches, robustly: x, y is a
/// place in the second view and v its vertical speed.
class RigFit {
 public:
  /// Adds the matches of one frame, which motion is in pixels per `seconds`. Forgets the oldest.
  void add(std::vector<RowMatch> matches, double seconds);

  RigEstimate estimate() const;

 private:
  struct Row {
    Eigen::Vector4d factors;  ///< of rows, roll, scale and delay
    double residual;
  };
  std::deque<std::vector<Row>> frames_;
};

}  // namespace internal
}  // namespace hypotrack
