#include "lab/report/replay.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "hypotrack/api/error.hpp"
#include "hypotrack/api/tables.hpp"
#include "hypotrack/plugin/kinematics.hpp"
#include "lab/json_file.hpp"
#include "lab/report/packed.hpp"

namespace hypotrack::internal {
namespace {

namespace fs = std::filesystem;

using States = std::vector<const Eigen::VectorXd*>;  // null: unknown

std::unique_ptr<Scene> open_models(const ConfigNode& models, const fs::path& file,
                                   PluginLoader& plugins) {
  if (!models.is_list() || models.size() == 0)
    throw ConfigError(
        fmt::format("{}: has no list of models; expected the run.yaml that `hypotrack run` wrote",
                    file.string()));
  std::vector<std::pair<std::string, std::shared_ptr<const Model>>> made;
  for (std::size_t i = 0; i < models.size(); ++i) {
    const ConfigNode node = models.at(i);
    const ConfigNode name = node.get("name");
    std::shared_ptr<const Model> model = plugins.make<Model>(node, nullptr, {"name"});
    made.emplace_back(name.is_scalar() ? name.scalar() : node.get("type").scalar(),
                      std::move(model));
  }
  return std::make_unique<Scene>(std::move(made));
}

std::uint16_t quantised_unit(double value) {
  return static_cast<std::uint16_t>(static_cast<std::int16_t>(std::lround(32767 * value)));
}

/// Returns the rotations and translations from the bind pose to the world, per frame and bone.
Json bone_motion(const Scene& scene, const Scene::Item& item, const States& states) {
  const ModelData& data = item.model->data();
  const std::vector<Eigen::Isometry3d> bind = bind_transforms(data);
  std::vector<std::uint16_t> rotations;
  std::vector<double> translations;
  for (const Eigen::VectorXd* state : states) {
    if (!state) {
      rotations.insert(rotations.end(), 4 * bind.size(), 0);
      translations.insert(translations.end(), 3 * bind.size(),
                          std::numeric_limits<double>::quiet_NaN());
      continue;
    }
    const auto posed = world_from_bones(data, scene.part(item, *state));
    for (std::size_t b = 0; b < bind.size(); ++b) {
      const Eigen::Isometry3d moved = posed[b] * bind[b].inverse();
      const Eigen::Quaterniond q = Eigen::Quaterniond(moved.linear()).normalized();
      for (const double value : {q.x(), q.y(), q.z(), q.w()})
        rotations.push_back(quantised_unit(value));
      const Eigen::Vector3d t = moved.translation();
      translations.insert(translations.end(), t.begin(), t.end());
    }
  }
  return {{"bones", bind.size()}, {"q", pack_words(rotations)}, {"t", pack_numbers(translations)}};
}

/// Returns the landmarks per frame, for a model that poses itself.
Json point_motion(const Scene& scene, const Scene::Item& item, const States& states) {
  const std::size_t count = item.model->data().landmarks.size();
  std::vector<double> points;
  for (const Eigen::VectorXd* state : states) {
    if (!state) {
      points.insert(points.end(), 3 * count, std::numeric_limits<double>::quiet_NaN());
      continue;
    }
    const Eigen::Matrix3Xd posed = posed_landmarks(*item.model, scene.part(item, *state));
    points.insert(points.end(), posed.data(), posed.data() + posed.size());
  }
  return {{"points", count}, {"p", pack_numbers(points)}};
}

/// Returns the rows of a table for the given frames; null where it has none.
template <class Row, class Value>
std::vector<const Value*> on_frames(const std::vector<Row>& rows, Value Row::*value,
                                    const std::vector<int>& frames) {
  std::map<int, const Value*> known;
  for (const Row& row : rows) known[row.frame] = &(row.*value);
  std::vector<const Value*> found;
  for (const int frame : frames) {
    const auto it = known.find(frame);
    found.push_back(it == known.end() ? nullptr : it->second);
  }
  return found;
}

/// Returns the true landmarks, for runs without true states.
Json truth_points(const fs::path& file, const Scene& scene, const std::vector<int>& frames) {
  const std::vector<LandmarkRow> rows = read_landmarks(file, scene.landmark_names());
  const std::size_t count = scene.landmark_names().size();
  std::vector<double> points;
  for (const Eigen::Matrix3Xd* known : on_frames(rows, &LandmarkRow::landmarks, frames)) {
    if (known)
      points.insert(points.end(), known->data(), known->data() + known->size());
    else
      points.insert(points.end(), 3 * count, std::numeric_limits<double>::quiet_NaN());
  }
  return {{"count", count}, {"p", pack_numbers(points)}};
}

std::vector<StateRow> every_kth(std::vector<StateRow> rows) {
  const std::size_t step = (rows.size() + kMostReplayFrames - 1) / kMostReplayFrames;
  if (step <= 1) return rows;
  std::vector<StateRow> kept;
  for (std::size_t i = 0; i < rows.size(); i += step) kept.push_back(std::move(rows[i]));
  return kept;
}

}  // namespace

const ReplayCollector::OpenScene& ReplayCollector::open(const fs::path& run) {
  const fs::path file = run / "run.yaml";
  const ConfigNode models = ConfigNode::load(file).get("models");
  const std::string text = models.defined() ? models.to_yaml() : "";
  if (const auto it = scenes_.find(text); it != scenes_.end()) return it->second;
  OpenScene opened{.scene = open_models(models, file, *plugins_), .shapes = {}};
  for (const Scene::Item& item : opened.scene->items())
    opened.shapes.push_back(add_once(shapes_, known_shapes_, replay_shape(*item.model)));
  return scenes_.emplace(text, std::move(opened)).first->second;
}

int ReplayCollector::add_once(Json& list, std::map<std::string, int>& known, Json entry) {
  const auto [it, is_new] = known.emplace(entry.dump(), static_cast<int>(list.size()));
  if (is_new) list.push_back(std::move(entry));
  return it->second;
}

int ReplayCollector::add_motion(const Scene& scene, const Scene::Item& item, const States& states) {
  return add_once(motions_, known_motions_,
                  item.model->poses_itself() ? point_motion(scene, item, states)
                                             : bone_motion(scene, item, states));
}

Json ReplayCollector::add(const fs::path& run) {
  const OpenScene& opened = open(run);
  const Scene& scene = *opened.scene;
  const std::vector<StateRow> tracked = every_kth(read_states(run / "track.csv", scene));
  std::vector<int> frames;
  for (const StateRow& row : tracked) frames.push_back(row.frame);
  const fs::path states_file = run / "truth_states.csv";
  const fs::path landmarks_file = run / "truth_landmarks.csv";
  std::vector<StateRow> truth;
  if (fs::exists(states_file)) truth = read_states(states_file, scene);

  Json replay{{"frames", frames}, {"models", Json::array()}};
  for (std::size_t i = 0; i < scene.items().size(); ++i) {
    const Scene::Item& item = scene.items()[i];
    Json model{{"name", item.name}, {"shape", opened.shapes[i]}};
    model["tracked"] = add_motion(scene, item, on_frames(tracked, &StateRow::state, frames));
    if (!truth.empty())
      model["truth"] = add_motion(scene, item, on_frames(truth, &StateRow::state, frames));
    replay["models"].push_back(std::move(model));
  }
  if (truth.empty() && fs::exists(landmarks_file))
    replay["truth_points"] = truth_points(landmarks_file, scene, frames);
  return replay;
}

}  // namespace hypotrack::internal
