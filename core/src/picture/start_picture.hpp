#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/api/scene.hpp"
#include "tile/tiles.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// A state to draw over the views of a frame.
struct StartToDraw {
  Eigen::VectorXd state;             ///< size 0: none; the views are drawn bare
  std::vector<bool> hidden = {};     ///< for each model, true to leave it out; empty = none
  std::vector<std::string> caption;  ///< lines below the picture
};

/// Draws the views of a frame side by side, with the models, the tile's outline, some landmarks of
/// the first view and their epipolar lines in the second. The caption says in addition which share
/// of each model every view shows. If a model lies behind a camera, the views stay bare and the
/// caption says so.
cv::Mat draw_start(const Scene& scene, const std::vector<Camera>& cameras, const TileSettings& tile,
                   const Frame& frame, const StartToDraw& start);

}  // namespace internal
}  // namespace hypotrack
