#pragma once

#include <memory>
#include <vector>

#include "base/exported.hpp"
#include "track/occlude/occluder_finder.hpp"
#include "track/verify/pose_verifier.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Follows what hides the models of a scene. It costs nothing while nothing does.
class Occlusion {
 public:
  /// The scene must outlive it.
  Occlusion(const Scene& scene, const std::vector<Camera>& cameras);

  /// Returns whether something hid a model a moment ago.
  bool is_awaited() const { return awaited_ > 0; }
  /// Returns whether it looked at this frame.
  bool has_looked_at(const Frame& frame) const { return frame_ == frame.index; }
  /// Looks for what hides the flagged models, about where `state` (normalised) has them.
  void look(const Frame& frame, const Eigen::VectorXd& state, const ColorMap& colors,
            const PoseVerifier& verifier, const std::vector<bool>& models);
  /// Returns the hidden parts of the last frame looked at; null: none.
  const std::shared_ptr<const HiddenViews>& hidden() const { return hidden_; }

 private:
  const Scene& scene_;
  std::vector<Camera> cameras_;
  std::vector<OccluderFinder> finders_;  ///< by model, made when first needed
  std::shared_ptr<const HiddenViews> hidden_;
  int frame_ = -1;   ///< looked at last
  int awaited_ = 0;  ///< frames for which occluders are looked for without a sign of one
};

}  // namespace internal
}  // namespace hypotrack
