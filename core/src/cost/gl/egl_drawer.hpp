#pragma once

#include <Eigen/Core>
#include <memory>

#include "cost/gl/egl_layers.hpp"
#include "hypotrack/observation.hpp"
#include "hypotrack/scene.hpp"

namespace hypotrack {

/// Draws batches of hypotheses with OpenGL, as the paper did: skinning in the vertex shader,
/// inverse depth in a texture array where the larger value wins, a layer per hypothesis and view.
class EglDrawer {
 public:
  /// The scene must outlive the drawer. Throws DeviceError if no context can be made, or it cannot
  /// choose layers in the vertex shader.
  explicit EglDrawer(const Scene& scene);
  ~EglDrawer();
  EglDrawer(const EglDrawer&) = delete;
  EglDrawer& operator=(const EglDrawer&) = delete;

  /// Takes a frame's cameras. Throws DeviceError on tiles beyond what OpenGL can do.
  void prepare(const Observation& observation);

  int views() const;
  /// The most hypotheses of the frame that one draw() takes.
  Eigen::Index largest_batch() const;
  /// What a batch of hypotheses is drawn to.
  LayerSize layers_for(Eigen::Index hypotheses) const;

  /// Draws the columns of `states` (normalised). View v of the i-th goes to layer
  /// i * views() + v, its pixel (x, y) to texel (x, y); all other texels are 0.
  void draw(const Eigen::Ref<const Eigen::MatrixXd>& states, const EglLayers& to);

  /// Where the layers must be made.
  const gl::Context& context() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hypotrack
