#include "dataset.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hypotrack/api/config.hpp"
#include "hypotrack/plugin/kinematics.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "motion/gestures.hpp"
#include "motion/script.hpp"
#include "penetration.hpp"
#include "test_paths.hpp"

namespace hypotrack::test {
namespace {

constexpr double kFrameRate = 30;

Scene make_scene(const ConfigNode& models) {
  PluginLoader plugins;
  std::vector<std::pair<std::string, std::shared_ptr<const Model>>> made;
  for (std::size_t i = 0; i < models.size(); ++i) {
    const ConfigNode model = models.at(i);
    made.emplace_back(model.get("name").scalar(), plugins.make<Model>(model, nullptr, {"name"}));
  }
  return Scene(std::move(made));
}

/// `index` of `index_2`; fixed bones (`index_0`, `wrist`) belong to the palm.
std::string digit_of(const std::string& bone) {
  const std::size_t split = bone.find('_');
  if (split == std::string::npos || bone[split + 1] == '0') return "palm";
  return bone.substr(0, split);
}

/// 1, 2 or 3 of a digit's moving bones.
int segment_of(const std::string& bone) { return bone.back() - '0'; }

int main_bone(const Mesh& mesh, Eigen::Index vertex) {
  Eigen::Index most = 0;
  mesh.bone_weights.col(vertex).maxCoeff(&most);
  return mesh.bone_indices(most, vertex);
}

Eigen::Matrix3Xf selected(const Eigen::Matrix3Xf& all, const std::vector<int>& columns) {
  Eigen::Matrix3Xf some(3, static_cast<Eigen::Index>(columns.size()));
  for (std::size_t i = 0; i < columns.size(); ++i)
    some.col(static_cast<Eigen::Index>(i)) = all.col(columns[i]);
  return some;
}

}  // namespace

Dataset load_dataset(const std::string& name) {
  const ConfigNode file = ConfigNode::load(source_dir() / "configs/scenes" / (name + ".yaml"));
  Dataset dataset{make_scene(file.get("models")), {}};
  const ConfigNode source = file.get("source");
  const ConfigNode shared = source.get("gesture_file");
  const synthetic::Gestures gestures(source.get("gestures"),
                                     shared.defined() ? source.directory() / shared.scalar() : "");
  const synthetic::Script script =
      synthetic::read_script(source.get("keyframes"), gestures, dataset.scene, kFrameRate);
  const int frames = static_cast<int>(std::lround(script.duration * kFrameRate)) + 1;
  for (int f = 0; f < frames; ++f)
    dataset.states.push_back({f, f / kFrameRate, script.motion.state(f / kFrameRate)});
  return dataset;
}

Eigen::Matrix3Xf vertices(const Dataset& dataset, std::size_t model, int frame) {
  const Scene::Item& item = dataset.scene.items()[model];
  const Eigen::VectorXd& state = dataset.states[static_cast<std::size_t>(frame)].state;
  return posed_vertices(*item.model, dataset.scene.part(item, state));
}

std::vector<HandPart> hand_parts(const ModelData& hand) {
  std::vector<HandPart> parts;
  for (const char* name : {"palm", "thumb", "index", "middle", "ring", "little"}) {
    HandPart part{name, {}, {}};
    const auto belongs = [&](Eigen::Index vertex) {
      return digit_of(hand.bones[static_cast<std::size_t>(main_bone(hand.mesh, vertex))].name) ==
             part.name;
    };
    for (Eigen::Index v = 0; v < hand.mesh.vertices.cols(); ++v) {
      const auto& bone = hand.bones[static_cast<std::size_t>(main_bone(hand.mesh, v))].name;
      if (belongs(v) && part.name != "palm" && segment_of(bone) >= 2)
        part.outer.push_back(static_cast<int>(v));
    }
    std::vector<Eigen::Index> kept;
    for (Eigen::Index t = 0; t < hand.mesh.triangles.cols(); ++t) {
      int inside = 0;
      for (int k = 0; k < 3; ++k) inside += belongs(hand.mesh.triangles(k, t));
      if (inside >= 2) kept.push_back(t);
    }
    part.triangles = hand.mesh.triangles(Eigen::all, kept);
    parts.push_back(std::move(part));
  }
  return parts;
}

double self_penetration(const std::vector<HandPart>& parts, const Eigen::Matrix3Xf& vertices) {
  double deepest = 0;
  for (const HandPart& part : parts) {
    const Eigen::Matrix3Xf points = selected(vertices, part.outer);
    for (const HandPart& other : parts) {
      // The ball of the thumb folds into the palm's skin where it is one with it.
      if (&other == &part || (part.name == "thumb" && other.name == "palm")) continue;
      deepest = std::max(deepest, penetration(points, vertices, other.triangles));
    }
  }
  return deepest;
}

}  // namespace hypotrack::test
