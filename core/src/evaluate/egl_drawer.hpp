#pragma once

#include <hwy/aligned_allocator.h>

#include <Eigen/Core>
#include <memory>
#include <string>

#include "hypotrack/objective.hpp"
#include "hypotrack/observation.hpp"
#include "hypotrack/scene.hpp"

namespace hypotrack {

/// Draws batches of hypotheses with OpenGL, as the paper did: skinning in the vertex shader,
/// inverse depth in a floating-point colour attachment where the larger value wins, the tiles of a
/// batch one below the other in one framebuffer.
class EglDrawer {
 public:
  /// The scene must outlive the drawer. Throws DeviceError if no context can be made.
  explicit EglDrawer(const Scene& scene);
  ~EglDrawer();
  EglDrawer(const EglDrawer&) = delete;
  EglDrawer& operator=(const EglDrawer&) = delete;

  /// Takes a frame's cameras. Throws DeviceError on tiles beyond what OpenGL can do.
  void prepare(const Observation& observation);

  int views() const;
  /// The most hypotheses that one draw() takes.
  Eigen::Index batch_size() const;

  /// Draws columns first .. first + count - 1 of `states` (normalised).
  void draw(const Eigen::MatrixXd& states, Eigen::Index first, Eigen::Index count);

  /// Tile of the i-th hypothesis of the last batch, valid until the next draw() or prepare().
  DepthTile tile(Eigen::Index i, int view) const;

  const std::string& device() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hypotrack
