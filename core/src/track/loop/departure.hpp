#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/scene.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Tells whether lost models have left the pictures: where their last motion carries them, no
/// picture shows most of their landmarks.
class Departure {
 public:
  /// The scene must outlive it.
  Departure(const Scene& scene, std::vector<Camera> cameras);

  /// Remembers the poses of the flagged models, which are about right.
  void remember(const Eigen::VectorXd& state, double time, const std::vector<bool>& models);
  void forget() { seen_.assign(seen_.size(), {}); }

  /// Returns whether a model that was not found since remember() has left all pictures by a time.
  bool is_gone(std::size_t model, double time) const;

 private:
  struct Seen {
    Eigen::Matrix3Xd landmarks = {};  ///< in the world; empty: never seen
    Eigen::Matrix3Xd velocities = {};
    double time = 0;
  };

  const Scene& scene_;
  std::vector<Camera> cameras_;
  std::vector<Seen> seen_;  ///< by model
};

}  // namespace internal
}  // namespace hypotrack
