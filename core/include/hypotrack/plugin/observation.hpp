#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <limits>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "hypotrack/api/scene.hpp"

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

/// A square crop of one view around the last solution.
struct TileView {
  TileCamera camera;
  cv::Mat color;  ///< 8-bit BGR; empty if the view has none
  cv::Mat valid;  ///< 8-bit; non-zero where the pixel lies inside the source image
  cv::Mat mask;   ///< 8-bit foreground; empty if the view has none
  cv::Mat depth;  ///< 32-bit float z along the tile camera's axis, metres; 0 = not measured; never
                  ///< interpolated; empty if the view has none
  cv::Mat background;  ///< 8-bit BGRA: colour without the models, and alpha 255 where it is known;
                       ///< empty while nothing is known
};

/// The answer of an earlier frame, from which the tracker goes on.
struct PreviousSolution {
  int frame = 0;
  double time = 0;        ///< seconds
  double cost = 0;        ///< NaN if it was not evaluated
  Eigen::VectorXd state;  ///< Scene::dimension() numbers, unsmoothed
  /// The tiles around `state` in that frame, with camera, colour and `valid` only. Empty unless a
  /// term of the scene has ImageUse::previous. They are in memory of the CPU, also where hypotheses
  /// are evaluated on a GPU.
  std::vector<TileView> views;
};

/// What a tracker tells objectives of a frame besides its images and cameras.
struct FrameContext {
  /// True until a solution exists: the start is then the scene's given start, perhaps some
  /// centimetres off. A term should trust less what it learns from such a frame. It should learn
  /// anew from the first one without this flag, which may show the same frame
  /// (search.second_search).
  bool start_is_guess = false;
  /// True if the search must not assume a motion from the start, as in fixed-lag smoothing, where
  /// one prior covers all frames together. Temporal terms then contribute nothing.
  bool no_motion_prior = false;
  /// Median colour difference of the same surface between the first two views, at recent solutions
  /// and after photometric correction. It is mostly noise. Euclidean norm of RGB in 0..1; 0 =
  /// unknown.
  double color_difference = 0;
  /// The last frame that was tracked or uncertain, the same for all searches of a frame. It stays
  /// while models are lost. Null before the first one, after the models were forgotten, and with
  /// `no_motion_prior`. A term may keep it.
  std::shared_ptr<const PreviousSolution> previous;
  /// Seconds from `previous` to this frame, above 0; NaN without `previous`.
  double seconds_since_previous = std::numeric_limits<double>::quiet_NaN();
};

/// The tiles of one frame, with views in the order of the source's cameras.
struct Observation {
  int frame = 0;
  double time = 0;
  const Scene* scene = nullptr;  ///< outlives the observation
  Eigen::VectorXd start;         ///< state that the tiles were cropped around; the search starts
                                 ///< at or near it
  FrameContext context;
  std::vector<TileView> views;
  /// True for two views whose cameras share rotation, fx, fy and cy. A point then has the same y in
  /// both views, and x_left - x_right is a constant plus fx * baseline / z.
  bool rectified = false;
};

}  // namespace hypotrack
