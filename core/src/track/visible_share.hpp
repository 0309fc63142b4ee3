#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>

#include "hypotrack/camera.hpp"
#include "hypotrack/export.hpp"
#include "hypotrack/scene.hpp"

namespace hypotrack {

/// How much of a scene its cameras see, whatever hides it. Reuses its memory: one per thread.
class HYPOTRACK_API VisibleShare {
 public:
  /// The scene must outlive it. At least one camera.
  VisibleShare(const Scene& scene, std::span<const Camera> cameras);
  ~VisibleShare();

  /// Share of the models' vertices that every image shows; 0 if any lies behind a camera. `state`
  /// is normalised.
  double of(const Eigen::VectorXd& state);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hypotrack
