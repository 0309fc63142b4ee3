#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "hypotrack/camera.hpp"
#include "hypotrack/export.hpp"
#include "hypotrack/frame.hpp"
#include "tile/color_map.hpp"
#include "track/judge/foreground_colors.hpp"

namespace hypotrack {

/// A place where a model may be.
struct Place {
  Eigen::Vector3d center;  ///< in the world, metres
  double score = 0;        ///< larger is likelier; compares within one frame
  /// Points at its depth, spread over what has the model's colours around it.
  std::vector<Eigen::Vector3d> points = {};
};

struct ReducedView;

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

  /// Finds up to `count` places. Each shows the model's colours where the places before it do not.
  /// `map` makes the second view's colours the first's. `weights` (0 .. 1) of the reduced pictures'
  /// pixels are their chance to show the model, whatever their colours; empty: all 1.
  Places find(const Frame& frame, const ForegroundColors& colors, const ColorMap& map,
              std::size_t count, const std::array<cv::Mat1f, 2>& weights = {}) const;

  /// Pixels of a view (0 or 1) along one pixel of its reduced picture.
  int reduction(std::size_t view) const { return reductions_[view]; }
  /// The reduced picture of a view (0 or 1).
  cv::Mat3b reduced(const cv::Mat& picture, std::size_t view) const;

 private:
  /// A point of the sweep in one view: pixel and radius in the reduced picture.
  struct Window {
    float x = 0, y = 0, r = 0;
  };
  struct Point {
    Eigen::Vector3f center;
    Window windows[2];
  };
  /// A point that may be a place.
  struct Candidate {
    const Point* point;
    double share;  ///< of the model's colours in its windows, where that is smaller
    double score;
  };
  using Views = std::array<ReducedView, 2>;

  /// Scores the points, best first. `seen` is Places::seen.
  std::vector<Candidate> sweep(const Views& views, double& seen) const;
  /// The point on the first camera's ray at which both views agree best.
  Eigen::Vector3d at_best_depth(const Views& views, const Eigen::Vector3d& center) const;
  /// Place::points of a place.
  std::vector<Eigen::Vector3d> points_around(const ReducedView& first,
                                             const Eigen::Vector3d& center) const;
  /// Takes out of a view what a model at a place would show.
  void explain(ReducedView& view, std::size_t i, const Eigen::Vector3d& center) const;

  std::vector<Camera> cameras_;
  double radius_;
  double inverse_step_;  ///< of 1/z between the planes of the sweep
  std::vector<Point> points_;
  int reductions_[2] = {1, 1};
};

}  // namespace hypotrack
