#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "hypotrack/scene.hpp"

namespace hypotrack {

/// The pinhole camera of a tile, after undistortion, rectification, cropping and scaling. Pixel
/// centres are at integers.
struct TileCamera {
  int width = 0;
  int height = 0;
  double fx = 0;
  double fy = 0;
  double cx = 0;
  double cy = 0;
  Eigen::Isometry3d camera_from_world = Eigen::Isometry3d::Identity();
};

/// A square piece of one view around the last solution.
struct TileView {
  TileCamera camera;
  cv::Mat color;  ///< 8-bit BGR, empty if the view has none
  cv::Mat valid;  ///< 8-bit: non-zero where the pixel comes from inside the image
  cv::Mat mask;   ///< 8-bit foreground, empty if the view has none
  cv::Mat depth;  ///< 32-bit float z in metres along the tile camera's axis, 0: not measured (never
                  ///< a mixture of two pixels); empty if the view has none
};

/// What an objective gets once per frame. Views are in the order of the source's cameras.
struct Observation {
  int frame = 0;
  double time = 0;
  const Scene* scene = nullptr;  ///< outlives the observation
  Eigen::VectorXd start;         ///< the scene's state that the tiles were cut around: where the
                                 ///< search starts, or near it
  /// Nothing has been found yet, and `start` is where the scene was told to be: some centimetres
  /// off, maybe. What a term learns there is worth less, and is better learned anew from the first
  /// observation without this, which may be of the same frame (search.second_look).
  bool start_is_guess = false;
  std::vector<TileView> views;
  /// Two views whose cameras share rotation, fx, fy and cy: a point has the same y in both, and
  /// x_left - x_right is a constant plus fx * baseline / z.
  bool rectified = false;
  /// Median distance of the colours that the first two views showed of the same surface, at the
  /// solutions of recent frames and after what `photometric` does: noise, mostly. The Euclidean
  /// norm of red, green and blue in 0..1; 0: not known.
  double color_difference = 0;
  /// Later frames are known too, and what motion is likely is weighed over all of them together
  /// (hindsight): a term about the way here from `start` has no say.
  bool in_hindsight = false;
};

}  // namespace hypotrack
