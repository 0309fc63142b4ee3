#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/exported.hpp"
#include "track/rig/rectified_pair.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// A place that both views of a rectified pair show, in pixels.
struct RowMatch {
  Eigen::Vector2d at;   ///< in the second view, from the principal point
  double residual = 0;  ///< rows by which the second view shows it lower
};

/// How far to look for matches, in pixels.
struct MatchRange {
  double disparity = 0;  ///< largest
  int rows = 0;          ///< largest residual
};

/// Matches corners from all over the first picture along the rows of the second.
std::vector<RowMatch> match_rows(const GreyPair& pictures, const Eigen::Vector2d& center,
                                 const MatchRange& range);

}  // namespace internal
}  // namespace hypotrack
