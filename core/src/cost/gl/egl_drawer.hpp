#pragma once

#include <Eigen/Core>
#include <memory>

#include "base/exported.hpp"
#include "cost/gl/egl_layers.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/observation.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Draws batches of hypotheses with OpenGL, as in the paper. The vertex shader skins. Inverse depth
/// goes to a texture array, one layer per hypothesis and view, where the larger value wins.
class EglDrawer {
 public:
  /// The scene must outlive the drawer. Throws DeviceError if no context can be made or its vertex
  /// shader cannot select layers.
  explicit EglDrawer(const Scene& scene);
  ~EglDrawer();
  EglDrawer(const EglDrawer&) = delete;
  EglDrawer& operator=(const EglDrawer&) = delete;

  /// Sets a frame's cameras. Throws DeviceError on tiles beyond OpenGL's limits.
  void prepare(const Observation& observation);

  int views() const;
  /// Returns the most hypotheses of the frame that one draw() accepts.
  Eigen::Index largest_batch() const;
  /// Returns the size of the texture array for a number of hypotheses.
  LayerSize layers_for(Eigen::Index hypotheses) const;

  /// Draws the columns of `states` (normalised). View v of column i goes to layer i * views() + v,
  /// its pixel (x, y) to texel (x, y). All other texels are 0.
  void draw(const Eigen::Ref<const Eigen::MatrixXd>& states, const EglLayers& to);

  /// Returns the context in which the layers must be made.
  const gl::Context& context() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace internal
}  // namespace hypotrack
