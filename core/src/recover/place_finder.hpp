#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "geometry/color_map.hpp"
#include "hypotrack/camera.hpp"
#include "hypotrack/export.hpp"
#include "hypotrack/frame.hpp"
#include "judge/foreground_colors.hpp"

namespace hypotrack {

/// A place where a model may be.
struct Place {
  Eigen::Vector3d center;  ///< in the world, metres
  double score = 0;        ///< larger is likelier; compares within one frame
};

/// What whole pictures show of a model's colours.
struct Places {
  std::vector<Place> best;  ///< best first
  /// The largest share of the model's colours in a window of its size, in the picture where that is
  /// smaller: near 0 if one of them shows no such thing.
  double seen = 0;
};

/// Looks over whole pictures for places where both views show a model's colours and agree: a plane
/// sweep with windows of the model's size (Collins, "A space-sweep approach to true multi-image
/// matching", CVPR 1996).
class HYPOTRACK_API PlaceFinder {
 public:
  /// Looks for models of about `radius` metres between two depths before the first camera.
  PlaceFinder(const std::vector<Camera>& cameras, double radius, double nearest, double farthest);

  /// Finds up to `count` places, at least `apart` metres from each other. `map` makes the second
  /// view's colours the first's. `taken` are pixels of the reduced pictures that show other models;
  /// empty: none.
  Places find(const Frame& frame, const ForegroundColors& colors, const ColorMap& map,
              std::size_t count, double apart, const std::array<cv::Mat1b, 2>& taken = {}) const;

  /// Pixels of a view (0 or 1) along one pixel of its reduced picture.
  int reduction(std::size_t view) const { return reductions_[view]; }

 private:
  /// A point of the sweep in one view: pixel and radius in the reduced picture.
  struct Window {
    float x = 0, y = 0, r = 0;
  };
  struct Point {
    Eigen::Vector3f center;
    Window windows[2];
  };

  std::vector<Camera> cameras_;
  double radius_;
  std::vector<Point> points_;
  int reductions_[2] = {1, 1};
};

}  // namespace hypotrack
