#pragma once

#include <deque>
#include <vector>

#include "base/exported.hpp"
#include "track/rig/row_matches.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// How the second view of a pair differs from its calibration.
struct RigEstimate {
  double rows = 0;   ///< pixels by which it is lower at the principal point
  double roll = 0;   ///< radians, clockwise
  double scale = 0;  ///< share by which it is larger

  double row_error = 0;        ///< root mean square of the rows at the matches, pixels
  double row_error_sigma = 0;  ///< its standard deviation
  int matches = 0;
};

/// Fits rows + roll x + scale y to the residuals of matches, robustly: x, y is a place in the
/// second view.
class RigFit {
 public:
  /// Adds the matches of one frame. Forgets the oldest.
  void add(const std::vector<RowMatch>& matches);

  RigEstimate estimate() const;

 private:
  std::deque<std::vector<RowMatch>> frames_;
};

}  // namespace internal
}  // namespace hypotrack
