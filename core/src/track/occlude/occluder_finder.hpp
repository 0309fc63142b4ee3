#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/api/scene.hpp"
#include "tile/color_map.hpp"
#include "track/occlude/hidden_views.hpp"
#include "track/verify/foreground_colors.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Finds surfaces that stand before a model and belong to no model of the scene, by semi-global
/// matching of a rectified pair. Source: Hirschmueller, "Stereo processing by semiglobal matching
/// and mutual information", PAMI 2008.
class OccluderFinder {
 public:
  /// The scene must outlive the finder.
  OccluderFinder(const Scene& scene, std::size_t model, const std::vector<Camera>& cameras);
  ~OccluderFinder();
  OccluderFinder(OccluderFinder&&) noexcept;

  /// Returns what hides the model, about where `state` (normalised) has it. `colors` maps the
  /// second view's colours to the first's, `foreground` are those of the model. Nothing for pairs
  /// that are not nearly parallel with the left camera first, and where nothing is found.
  std::optional<std::array<HiddenPart, 2>> find(const Frame& frame, const Eigen::VectorXd& state,
                                                const ColorMap& colors,
                                                const ForegroundColors& foreground);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace internal
}  // namespace hypotrack
