#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/model.hpp"
#include "hypotrack/plugin/plugin.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Collects the 3D replays of runs for the page. Meshes and motions that several runs share (the
/// truth of a data set, the same model) are stored once.
class ReplayCollector {
 public:
  explicit ReplayCollector(PluginLoader& plugins) : plugins_(&plugins) {}

  /// Adds a run folder and returns its replay, from the models in its run.yaml, its track.csv and
  /// its truth (states, or else landmarks):
  ///
  ///   {frames: [...], models: [{name, shape, tracked, truth}, ...],
  ///    truth_points: {count, p} or absent}
  ///
  /// `shape`, `tracked` and `truth` are indices into shapes() and motions(). Throws DataError,
  /// ConfigError or PluginError.
  nlohmann::ordered_json add(const std::filesystem::path& run);

  /// Returns [{box, vertices, triangles, bones, weights, landmarks: [{name, bone, p}], edges}, ...]
  /// with positions at the bind pose; without vertices for a model that poses itself.
  const nlohmann::ordered_json& shapes() const { return shapes_; }
  /// Returns [{bones, q, t}, ...]: per frame and bone the rotation and the translation from the
  /// bind pose to the world. Rotations are quaternions x y z w, 16-bit signed, 32767 is 1; all
  /// zero: unknown. Or {points, p}: per frame and landmark its position.
  const nlohmann::ordered_json& motions() const { return motions_; }

 private:
  struct OpenScene {
    std::unique_ptr<Scene> scene;
    std::vector<int> shapes;
  };
  const OpenScene& open(const std::filesystem::path& run);
  int add_once(nlohmann::ordered_json& list, std::map<std::string, int>& known,
               nlohmann::ordered_json entry);
  int add_motion(const Scene& scene, const Scene::Item& item,
                 const std::vector<const Eigen::VectorXd*>& states);

  PluginLoader* plugins_;
  std::map<std::string, OpenScene> scenes_;  ///< by the text of run.yaml's models
  nlohmann::ordered_json shapes_ = nlohmann::ordered_json::array();
  nlohmann::ordered_json motions_ = nlohmann::ordered_json::array();
  std::map<std::string, int> known_shapes_, known_motions_;
};

/// Frames of the longest replay that shows every frame. A replay of a longer run shows every k-th
/// frame.
inline constexpr std::size_t kMostReplayFrames = 1000;

}  // namespace internal
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns a model's mesh and skeleton in the format of ReplayCollector::shapes().
nlohmann::ordered_json replay_shape(const Model& model);

/// Returns pairs of landmarks to join by lines, each with the nearest one towards the root.
/// Landmarks of one bone form a chain from its origin outwards.
std::vector<std::pair<int, int>> skeleton_edges(const ModelData& data);

}  // namespace internal
}  // namespace hypotrack
