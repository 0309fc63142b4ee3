#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "session/opened_scene.hpp"
#include "track/recover/recovery.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// States that a recovery offers, and those that the scene's search makes of them.
struct RecoveredStates {
  std::vector<Eigen::VectorXd> candidates, searched;
};

/// Recovers the models of a scene, by the scene's own search, from states that are far off.
class PoseRecoveries {
 public:
  PoseRecoveries(const std::filesystem::path& scene, const std::vector<std::string>& overrides,
                 PluginLoader& plugins);

  /// Finds states in a frame for one model. `kept` has where it was `seconds` ago, and where the
  /// models with `shown` are.
  RecoveredStates find(const Frame& frame, const Eigen::VectorXd& kept, double seconds,
                       std::size_t model, const std::vector<bool>& shown, std::uint64_t seed);

  /// Learns the looks of all models in a state that is right.
  void learn(const Frame& frame, const Eigen::VectorXd& state);

 private:
  OpenedScene session_;
  const Scene& scene_;
  Budget budget_;
  MotionLimits limits_;
  PoseVerifier verifier_;
  Recovery recovery_;
  std::optional<FrameSearch> search_;
  bool first_ = true;
};

}  // namespace internal
}  // namespace hypotrack
