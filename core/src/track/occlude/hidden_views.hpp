#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/plugin/observation.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// A part of a view in which something hides models that is no model of the scene.
struct HiddenPart {
  TileCamera camera;
  cv::Mat1b mask;  ///< 255 where it hides what is behind it
};

/// Hidden parts of the first two views. They may overlap.
struct HiddenViews {
  std::array<std::vector<HiddenPart>, 2> parts;

  bool empty() const { return parts[0].empty() && parts[1].empty(); }
  /// Returns the hidden pixels of a tile of a view; empty if there are none.
  cv::Mat1b in_tile(std::size_t view, const TileCamera& tile) const;
  /// Returns which points (3xN, world) lie behind hidden pixels of both views.
  std::vector<bool> covers(const Eigen::Matrix3Xd& points) const;
};

}  // namespace internal
}  // namespace hypotrack
