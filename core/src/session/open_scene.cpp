#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "config/read_value.hpp"
#include "config/yaml_document.hpp"
#include "cost/cost.hpp"
#include "cost/cuda/page_locked_images.hpp"
#include "hypotrack/error.hpp"
#include "hypotrack/pose.hpp"
#include "hypotrack/tables.hpp"
#include "session/checked_source.hpp"
#include "session/opened_scene.hpp"
#include "track/displace.hpp"

namespace hypotrack {
namespace {

using detail::YamlDocument;

/// Builds a session part by part and records the resolved parameters of each.
class Opening {
 public:
  Opening(LoadedScene scene, PluginLoader& plugins)
      : file_(std::move(scene.file)),
        root_(std::move(scene.root)),
        plugins_(&plugins),
        record_(dump_params(file_)) {}

  /// Makes everything but the source.
  void tracker();
  void models();
  void source();
  void source(std::unique_ptr<Source> open, const std::string& resolved);
  void objective();
  void images();
  void optimizer();
  OpenedScene finish();

 private:
  template <class T>
  std::unique_ptr<T> make(const ConfigNode& node, std::vector<std::string> also_allowed,
                          YamlDocument& record) {
    std::string resolved;
    auto object = plugins_->make<T>(node, session_.scene.get(), std::move(also_allowed), &resolved);
    record = YamlDocument(resolved);
    return object;
  }

  SceneFile file_;
  ConfigNode root_;
  PluginLoader* plugins_;
  OpenedScene session_;
  YamlDocument record_;
};

/// Returns the text of a scalar key that core reads beside the plugin's own parameters.
std::string text_of(const ConfigNode& node, std::string_view key, std::string otherwise) {
  const ConfigNode value = node.get(key);
  if (!value.defined()) return otherwise;
  if (!value.is_scalar() || value.is_null() || value.scalar().empty())
    throw ConfigError(fmt::format("{}: {} must be a word", value.where(), key));
  return value.scalar();
}

struct WeightParam {
  double weight = 1;
  void visit(ParamVisitor& v) {
    v("weight", weight, {.help = "factor of this term", .min = 0, .max = 1e9});
  }
};

Eigen::VectorXd state_of_frame(const std::filesystem::path& file, const Scene& scene, int frame) {
  const std::vector<StateRow> rows = read_states(file, scene);
  for (const StateRow& row : rows)
    if (row.frame == frame) return row.state;
  if (rows.empty())
    throw DataError(fmt::format("{}: has no rows; expected one to start from", file.string()));
  throw DataError(fmt::format("{}: has no frame {} to start from; it has {} to {}", file.string(),
                              frame, rows.front().frame, rows.back().frame));
}

void Opening::tracker() {
  models();
  objective();
  optimizer();
}

void Opening::models() {
  if (!file_.models.is_list() || file_.models.size() == 0)
    throw ConfigError(fmt::format("{}: models is a list with at least one {{name, type, ...}}",
                                  file_.models.where()));
  std::vector<std::pair<std::string, std::shared_ptr<const Model>>> models;
  std::vector<YamlDocument> records;
  for (std::size_t i = 0; i < file_.models.size(); ++i) {
    const ConfigNode node = file_.models.at(i);
    YamlDocument record;
    std::shared_ptr<const Model> model = make<Model>(node, {"name"}, record);
    const std::string name = text_of(node, "name", text_of(node, "type", ""));
    if (name.find_first_of(". ,\"\n") != std::string::npos)
      throw ConfigError(
          fmt::format("{}: the name '{}' may not contain dots, commas, quotes or "
                      "spaces",
                      node.get("name").where(), name));
    const auto same = [&](const auto& other) { return other.first == name; };
    if (std::any_of(models.begin(), models.end(), same))
      throw ConfigError(fmt::format("{}: two models are called '{}'; give each a `name` of its own",
                                    node.get("name").where(), name));
    record.set_string("name", name);
    records.push_back(std::move(record));
    models.emplace_back(name, std::move(model));
  }
  record_.set_list("models", records);
  session_.scene = std::make_unique<Scene>(std::move(models));
}

void Opening::source() {
  if (!file_.source.defined()) detail::fail_at(root_.get("source"), "required key is missing");
  YamlDocument record;
  auto made = make<Source>(file_.source, {}, record);
  source(std::make_unique<CheckedSource>(std::move(made), *session_.scene,
                                         text_of(file_.source, "type", "")),
         record.text());
}

void Opening::source(std::unique_ptr<Source> open, const std::string& resolved) {
  session_.source = std::move(open);
  session_.source_resolved = resolved;
  record_.set("source", YamlDocument(resolved));
  session_.parts.cameras = session_.source->cameras();
}

void Opening::objective() {
  const bool list = file_.objective.is_list();
  const std::size_t count = list ? file_.objective.size() : 1;
  if (count == 0)
    throw ConfigError(fmt::format("{}: no objective is given", file_.objective.where()));
  std::vector<YamlDocument> records;
  for (std::size_t i = 0; i < count; ++i) {
    const ConfigNode node = list ? file_.objective.at(i) : file_.objective;
    YamlDocument record;
    ObjectiveTerm term;
    term.name = text_of(node, "type", "");
    term.objective = make<Objective>(node, {"weight"}, record);
    const ConfigNode weight = node.get("weight");
    if (weight.defined()) term.weight = ParamReader(node, node.keys()).read<WeightParam>().weight;
    record.set_plain("weight", fmt::format("{}", term.weight));
    records.push_back(std::move(record));
    session_.parts.objective.push_back(std::move(term));
  }
  const auto& terms = session_.parts.objective;
  if (std::ranges::all_of(terms, [](const ObjectiveTerm& term) { return term.weight == 0; }))
    throw ConfigError(
        fmt::format("{}: objective: the weight of {} is 0, so that every pose costs the same; give "
                    "one a weight above 0",
                    file_.objective.where(), count == 1 ? "its only term" : "each of its terms"));
  record_.set_list("objective", records);
}

/// Page-locks image memory if a GPU will read it. Call before the source makes images.
void Opening::images() {
  const EvaluateSettings& settings = file_.evaluate;
  if (evaluates_with_cuda(*session_.scene, session_.parts.objective, settings,
                          requirements_of(session_.parts)))
    cuda::page_lock_images(settings.device);
}

void Opening::optimizer() {
  YamlDocument record;
  session_.parts.optimizer = make<Optimizer>(file_.optimizer, {}, record);
  record_.set("optimizer", record);
}

OpenedScene Opening::finish() {
  session_.parts.tile = file_.tile;
  session_.parts.evaluate = file_.evaluate;
  session_.parts.photometric = file_.photometric;
  session_.parts.search = file_.search;
  session_.parts.status = file_.tracker;
  session_.parts.smoothing = file_.output.smoothing;
  session_.parts.hindsight = file_.hindsight;
  session_.parts.budget.evaluations = file_.budget.evaluations;
  if (file_.budget.seconds > 0) session_.parts.budget.seconds = file_.budget.seconds;
  session_.init = file_.init;
  session_.output = file_.output;
  session_.shape = file_.shape;
  session_.seed = static_cast<std::uint64_t>(file_.seed);
  session_.resolved = record_.text();
  return std::move(session_);
}

}  // namespace

OpenedScene open_scene(const std::filesystem::path& scene_file,
                       std::span<const std::string> overrides, PluginLoader& plugins) {
  Opening opening(load_scene(scene_file, overrides), plugins);
  opening.tracker();
  opening.images();
  opening.source();
  return opening.finish();
}

OpenedScene open_scene(const std::filesystem::path& scene_file,
                       std::span<const std::string> overrides, PluginLoader& plugins,
                       std::unique_ptr<Source> source, const std::string& source_resolved) {
  Opening opening(load_scene(scene_file, overrides), plugins);
  opening.tracker();
  opening.images();
  opening.source(std::move(source), source_resolved);
  return opening.finish();
}

OpenedScene open_without_source(const std::filesystem::path& scene_file,
                                std::span<const std::string> overrides, PluginLoader& plugins) {
  Opening opening(load_scene(scene_file, overrides), plugins);
  opening.tracker();
  return opening.finish();
}

OpenedScene open_source(const std::filesystem::path& scene_file,
                        std::span<const std::string> overrides, PluginLoader& plugins) {
  Opening opening(load_scene(scene_file, overrides), plugins);
  opening.models();
  opening.source();
  return opening.finish();
}

std::unique_ptr<Hindsight> make_hindsight(const OpenedScene& session) {
  const TrackerParts& parts = session.parts;
  if (!parts.hindsight.enabled) return nullptr;
  if (parts.status.uncertainty.enabled)
    throw ConfigError(
        "hindsight.enabled and tracker.uncertainty.enabled are both on, but sigmas are of states "
        "as "
        "they were found; switch one of them off");
  return std::make_unique<Hindsight>(*session.scene, parts.objective, parts.evaluate,
                                     parts.hindsight,
                                     parts.photometric.match && parts.photometric.highlights);
}

Eigen::VectorXd initial_state(const OpenedScene& session, const Frame& first) {
  const Scene& scene = *session.scene;
  Eigen::VectorXd state = scene.rest_state();
  if (session.init.from == InitFrom::truth) {
    if (!first.truth || first.truth->state.size() == 0)
      throw ConfigError(
          "init.from is 'truth' but the source knows no true state for its first frame; give "
          "init.pose or init.file instead");
    state = first.truth->state;
    scene.check(state, fmt::format("the source's true state of frame {}", first.index));
  } else if (session.init.from == InitFrom::file) {
    const std::string suffix = session.init.file.extension().string();
    state = suffix == ".yaml" || suffix == ".yml"
                ? read_pose(ConfigNode::load(session.init.file), scene, std::move(state))
                : state_of_frame(session.init.file, scene, session.init.frame);
    scene.check(state, session.init.file.string());
  }
  if (session.init.pose.defined()) state = read_pose(session.init.pose, scene, std::move(state));
  const InitSettings& init = session.init;
  if (init.away == 0 && init.away_turn == 0 && init.away_angles == 0) return state;
  return displaced(scene, std::move(state), {init.away, init.away_turn, init.away_angles},
                   session.seed);
}

}  // namespace hypotrack
