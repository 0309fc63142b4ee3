#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/exported.hpp"
#include "track/rig/rectified_pair.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// A place that both views of a rectified pair show, in pixels.
struct RowMatch {
  Eigen::Vector2d at;      ///< in the second view, from the principal point
  double residual = 0;     ///< rows by which the second view shows it lower
  Eigen::Vector2d motion;  ///< in the first view, since the picture before
};

/// How far to look for matches, in pixels.
struct MatchRange {
  double disparity = 0;  ///< largest
  int rows = 0;          ///< largest residual
};

/// Matches corners of the first picture along the rows of the second, half of them where the first
/// picture changed since the one before. `before` has no pictures at the start: motion is 0 then.
std::vector<RowMatch> match_rows(const GreyPair& now, const GreyPicture& before,
                                 const Eigen::Vector2d& center, const MatchRange& range);

}  // namespace internal
}  // namespace hypotrack
