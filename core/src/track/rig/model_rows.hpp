#pragma once

#include <Eigen/Core>
#include <optional>

#include "base/exported.hpp"
#include "hypotrack/frame.hpp"
#include "hypotrack/scene.hpp"
#include "tile/tiles.hpp"
#include "track/color/color_samples.hpp"
#include "track/rig/delay_fit.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Measures how the first two views of a nearly parallel pair show tracked models: how fast they
/// move across the rows, and by how much lower the second view has them.
class ModelRows {
 public:
  /// The scene must outlive the object.
  explicit ModelRows(const Scene& scene) : scene_(scene), sampler_(scene) {}

  /// Takes the next frame and its state. Returns a measurement in every third frame, if both views
  /// surely show the models and the frame before had them.
  std::optional<RowMotion> next(const Frame& frame, const TileMaker& tiles,
                                const Eigen::VectorXd& state);
  /// Takes a frame whose models are not known.
  void skip() { before_.reset(); }

 private:
  struct Moment {
    double time;
    Eigen::VectorXd state;
  };

  const Scene& scene_;
  ColorSampler sampler_;
  std::optional<Moment> before_;
  int frames_ = 0;
};

}  // namespace internal
}  // namespace hypotrack
