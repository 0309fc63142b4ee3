#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/frame.hpp"
#include "tile/color_map.hpp"
#include "track/verify/foreground_colors.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// A place where a model may be.
struct Place {
  Eigen::Vector3d center;  ///< in the world, metres
  double score = 0;        ///< larger is likelier; comparable within one frame
};

struct ReducedView;

/// Result of a search of the whole pictures for a model's colours.
struct Places {
  std::vector<Place> best;  ///< best first
  /// Largest mean foreground probability of a window of the model's size, in the view where it is
  /// smaller. Near 0 if a view does not show the model's colours.
  double seen = 0;
};

/// Searches whole pictures for places where both views agree and show a model's colours. It is a
/// plane sweep with windows of the model's size (Collins, "A space-sweep approach to true
/// multi-image matching", CVPR 1996).
class PlaceFinder {
 public:
  /// Searches for models of about `radius` metres between two depths (metres) from the first
  /// camera.
  PlaceFinder(const std::vector<Camera>& cameras, double radius, double nearest, double farthest);

  /// Finds up to `count` places, each with model colours that the places before do not explain.
  /// `map` maps the second view's colours to the first's. `weights` (0 .. 1, per pixel of the
  /// reduced pictures) multiply the foreground probability; empty: all 1.
  Places find(const Frame& frame, const ForegroundColors& colors, const ColorMap& map,
              std::size_t count, const std::array<cv::Mat1f, 2>& weights = {}) const;

  /// Returns the factor by which the picture of a view (0 or 1) is reduced.
  int reduction(std::size_t view) const { return reductions_[view]; }
  /// Returns the reduced picture of a view (0 or 1).
  cv::Mat3b reduced(const cv::Mat& picture, std::size_t view) const;

 private:
  /// A sample point of the sweep in one view: pixel and radius in the reduced picture.
  struct Window {
    float x = 0, y = 0, r = 0;
  };
  struct Point {
    Eigen::Vector3f center;
    Window windows[2];
  };
  /// A sample point that may be a place.
  struct Candidate {
    const Point* point;
    double share;  ///< mean foreground probability of its windows, smaller of both views
    double score;
  };
  using Views = std::array<ReducedView, 2>;

  /// Scores the sample points. Sets `seen` to Places::seen.
  std::vector<Candidate> sweep(const Views& views, double& seen) const;
  /// Returns the point on the first camera's ray at which both views agree best.
  Eigen::Vector3d at_best_depth(const Views& views, const Eigen::Vector3d& center) const;
  /// Removes from a view the foreground that a model at a place would explain.
  void explain(ReducedView& view, std::size_t i, const Eigen::Vector3d& center) const;

  std::vector<Camera> cameras_;
  double radius_;
  double least_inverse_, most_inverse_;  ///< of the depths that are swept, 1/metres
  std::vector<Point> points_;
  int reductions_[2] = {1, 1};
};

}  // namespace internal
}  // namespace hypotrack
