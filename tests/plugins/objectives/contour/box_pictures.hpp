#pragma once

#include <Eigen/Core>
#include <memory>

#include "contour.hpp"
#include "hypotrack/api/renderer.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/observation.hpp"
#include "test_paths.hpp"

namespace hypotrack::contour {

/// Draws a plain grey box of 60 x 40 x 120 mm before a spotted blue ground, as two cameras 60 mm
/// apart see it.
class BoxPictures {
 public:
  BoxPictures();

  const Scene& scene() const { return scene_; }
  /// Returns a state of the box, 0.5 m away and turned so that three sides are seen.
  Eigen::VectorXd state() const;
  /// Returns a state some millimetres and degrees off.
  Eigen::VectorXd displaced(const Eigen::Vector3d& metres, const Eigen::Vector3d& turn) const;

  /// Returns tiles of 160 x 160 pixels that show `state`, and their depth, with a search that
  /// starts at `start`.
  Observation seen(const Eigen::VectorXd& state, const Eigen::VectorXd& start);

  /// Returns the objective with a cache of its own, few views of which are drawn.
  std::unique_ptr<Contour> objective(double depth_sigma = 0) const;

 private:
  Scene scene_;
  Renderer renderer_;
  test::TemporaryDirectory cache_;
};

/// Returns the pictures, made once.
BoxPictures& box_pictures();

/// Returns the distance in millimetres of the box's corners in two states, on average.
double corner_distance_mm(const Eigen::VectorXd& a, const Eigen::VectorXd& b);

}  // namespace hypotrack::contour
