#pragma once

#include <array>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/api/scene.hpp"
#include "tile/color_map.hpp"
#include "track/occlude/hidden_views.hpp"
#include "track/verify/surface_points.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// One view around a drawn model, resampled to a square grid of points.
struct SampledView {
  cv::Mat3f color;   ///< B, G, R, 0 .. 255
  cv::Mat1b inside;  ///< 255 where the model is the nearest surface and the picture shows it
  cv::Mat1b ring;    ///< 255 beside its silhouette, where no model of the scene is drawn
};

/// Samples of a stereo pair on one model and around it.
struct SurfaceSamples {
  /// A fixed point of the surface.
  struct Point {
    cv::Point2f at;     ///< in the first view's grid
    bool seen = false;  ///< false: hidden, turned away or out of the picture
  };

  std::array<SampledView, 2> views;
  /// The second view's colour of the surface point at each point of the first view's grid. Beside
  /// the silhouette the surface is extended at the depth of its nearest point.
  cv::Mat3f other;
  cv::Mat1b paired;  ///< 255 where `other` is known; inside, where both views see the point
  std::vector<Point> points;
  double points_per_metre = 0;  ///< of the grid, at the model's depth
  double visible = 0;           ///< share of the model's vertices inside both pictures
  double covered = 0;           ///< share of its drawn points that other models or else hide

  bool empty() const { return other.empty(); }
};

/// Points along a side of the grid around a model.
inline constexpr int kSampleGrid = 64;

/// Samples the first two views of a frame around one model of a scene. Reuses its memory, so each
/// thread needs its own.
class SurfaceSampler {
 public:
  /// The scene must outlive the sampler.
  SurfaceSampler(const Scene& scene, std::size_t model, const std::vector<Camera>& cameras);
  ~SurfaceSampler();
  SurfaceSampler(SurfaceSampler&&) noexcept;

  /// Samples a frame with the scene posed in `state` (normalised). `colors` maps the second view's
  /// colours to the first's. The result is empty if a view has no colour or a camera does not see
  /// the model.
  SurfaceSamples sample(const Frame& frame, const Eigen::VectorXd& state, const ColorMap& colors);

  /// Sets what hides models in the frames sampled from now on; null: nothing.
  void hide(std::shared_ptr<const HiddenViews> hidden);

  /// Returns the points of the surface that samples show.
  const SurfacePoints& points() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace internal
}  // namespace hypotrack
