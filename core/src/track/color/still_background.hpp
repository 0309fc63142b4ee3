#pragma once

#include <span>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/api/scene.hpp"
#include "tile/tiles.hpp"
#include "track/color/background_model.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Learns the background of each view and cuts it into tiles.
class StillBackground {
 public:
  StillBackground(const Scene& scene, std::vector<Camera> cameras);

  /// Learns from a frame. The models' poses in `state` must be surely right.
  void learn(const Frame& frame, const Eigen::VectorXd& state);

  /// Writes TileView::background into a plan whose colours are matched.
  void add_to(TilePlan& plan, std::span<const Resampler> resamplers) const;

 private:
  const Scene& scene_;
  std::vector<Camera> cameras_;
  std::vector<BackgroundModel> views_;
};

}  // namespace internal
}  // namespace hypotrack
