#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <utility>
#include <vector>

#include "config/read_value.hpp"
#include "config/yaml.hpp"
#include "cost/cost.hpp"
#include "cost/cuda/memory/page_locked_images.hpp"
#include "gl/egl_context.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/text.hpp"
#include "plugin/param_keys.hpp"
#include "plugin/plugin_call.hpp"
#include "plugin/plugin_notes.hpp"
#include "session/opened_scene.hpp"

namespace hypotrack::internal {
namespace {

using detail::YamlDocument;

/// Builds a session part by part and records the resolved parameters of each.
class Opening {
 public:
  Opening(LoadedScene scene, PluginLoader& plugins)
      : file_(std::move(scene.file)),
        root_(std::move(scene.root)),
        plugins_(&plugins),
        record_(dump_params(file_)) {
    gl::prefer_gpu(file_.evaluate.device);
    session_.plugin_notes = std::make_shared<PluginNotes>();
    session_.notes = std::move(scene.notes);
  }

  /// Makes everything but the source.
  void tracker();
  void models();
  void source();
  void source(std::unique_ptr<Source> open, const std::string& resolved);
  void objective();
  void images();
  void optimizer();
  void judge();
  void starter();
  std::vector<std::unique_ptr<Starter>> starters(const ConfigNode& from,
                                                 std::vector<YamlDocument>& records);
  void outputs();
  OpenedScene finish();

 private:
  template <class T>
  std::unique_ptr<T> make(const ConfigNode& node, YamlDocument& record) {
    const std::vector<std::string> also_allowed = detail::scene_keys(kPluginKind<T>);
    std::string resolved;
    auto object = plugins_->make<T>(node, session_.scene.get(), also_allowed, &resolved,
                                    session_.plugin_notes);
    detail::set_label(*object, kPluginKind<T>, node);
    const ConfigNode parameters = ConfigNode::parse(resolved, "the plugin's parameters");
    for (const std::string& key : also_allowed)
      if (parameters.get(key).defined())
        throw PluginError(fmt::format(
            "{}: its parameter '{}' has a name that scenes take for every {}; rename it in the "
            "plugin",
            object->label(), key, kPluginKind<T>));
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

void Opening::tracker() {
  models();
  objective();
  optimizer();
  judge();
  starter();
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
    std::shared_ptr<const Model> model = make<Model>(node, record);
    if (model->data().landmarks.empty())
      throw PluginError(fmt::format(
          "{}: has no landmarks, expected one at least, such as its centre; this is a bug in the "
          "model",
          model->label()));
    const std::string name = text_of(node, "name", text_of(node, "type", ""));
    const auto allowed = [](unsigned char c) {
      return std::isalnum(c) || c == '_' || c == '-' || c >= 0x80;  // the rest of UTF-8
    };
    if (!std::ranges::all_of(name, allowed))
      throw ConfigError(
          fmt::format("{}: the name '{}' of a model holds other characters than "
                      "letters, digits, '_' and '-'",
                      node.get("name").where(), printable(name)));
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
  auto made = make<Source>(file_.source, record);
  made->check_for(*session_.scene);
  source(std::move(made), record.text());
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
    term.objective = make<Objective>(node, record);
    session_.term_times.push_back(
        {fmt::format("{} ({})", node.path(), term.name), term.objective->times()});
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
  session_.parts.optimizer = make<Optimizer>(file_.optimizer, record);
  record_.set("optimizer", record);
}

void Opening::judge() {
  ConfigNode node = file_.judge;
  if (node.is_scalar() && node.scalar() == kNoJudge) return;
  if (node.is_scalar()) {
    const std::pair<std::string, ConfigNode> type{"type", node};
    node = ConfigNode::map_of({&type, 1});
  }
  YamlDocument record;
  std::unique_ptr<Judge> judge = make<Judge>(node, record);
  const JudgeThresholds& t = judge->thresholds();
  if (t.uncertain_above > t.tracked_above)
    throw ConfigError(fmt::format(
        "{}: judge: uncertain_above is {}, more than tracked_above, which is {}; models below the "
        "first are lost",
        node.where(), t.uncertain_above, t.tracked_above));
  session_.parts.judge = std::move(judge);
  record_.set("judge", record);
}

std::vector<std::unique_ptr<Starter>> Opening::starters(const ConfigNode& from,
                                                        std::vector<YamlDocument>& records) {
  const std::vector<ConfigNode> nodes = starter_nodes(from, root_.get("init"));
  std::vector<std::unique_ptr<Starter>> all;
  std::string unusable;  // messages
  for (const ConfigNode& node : nodes) {
    YamlDocument record;
    try {
      all.push_back(make<Starter>(node, record));
    } catch (const DataError& e) {
      if (from.scalar() != kStartAuto) throw;
      session_.notes.push_back(fmt::format("{} goes without the starter {}: {}", kStartAuto,
                                           text_of(node, "type", ""), e.what()));
      unusable += (unusable.empty() ? "" : "; ") + std::string(e.what());
      continue;
    }
    if (nodes.size() > 1 && !all.back()->looks())
      detail::fail_at(node, fmt::format("'{}' gives a state and does not look for the models; "
                                        "expected it alone, or a list of starters that look",
                                        text_of(node, "type", "")));
    records.push_back(std::move(record));
  }
  if (all.empty()) detail::fail_at(from, "none of its starters can be used: " + unusable);
  return all;
}

void Opening::starter() {
  std::vector<YamlDocument> records;
  std::vector<std::unique_ptr<Starter>> all = starters(file_.init.from, records);
  TrackerParts& parts = session_.parts;
  parts.begins_by_looking = all.front()->looks();
  const InitSettings& init = file_.init;
  if (parts.begins_by_looking &&
      (init.pose.defined() || init.away != 0 || init.away_turn != 0 || init.away_angles != 0))
    detail::fail_at(
        root_.get("init"),
        "init.pose and init.away_* change a start that is given, and init.from looks for "
        "the models; leave one of them out");
  if (parts.begins_by_looking)
    parts.starters = std::move(all);
  else
    session_.starter = std::move(all.front());
  const std::string& word = file_.init.from.scalar();  // empty if it is a map or a list
  // The record has a word already, and the parameters of `file` and `clicks` beside it.
  const bool has_word =
      records.size() == 1 && (word == kStartFromFile || word == kStartFromClicks ||
                              records.front().text() == fmt::format("type: {}\n", word));
  if (!has_word) {
    YamlDocument resolved(dump_params(init));
    if (records.size() == 1)
      resolved.set("from", records.front());
    else
      resolved.set_list("from", records);
    record_.set("init", resolved);
  }
  ConfigNode from = file_.status.recovery.from;
  const bool is_same = !from.defined() || (from.scalar() == kStartAuto && word == kStartAuto);
  if (is_same && parts.begins_by_looking) return;
  if (!from.defined()) from = ConfigNode::parse("global_search", "the default of recovery.from");
  std::vector<YamlDocument> of_recovery;
  parts.starters = starters(from, of_recovery);
  for (const std::unique_ptr<Starter>& one : parts.starters)
    if (!one->looks())
      detail::fail_at(from,
                      "gives a state and does not look for lost models; expected starters "
                      "such as global_search");
}

void Opening::outputs() {
  const auto add = [&](const ConfigNode& node) {
    YamlDocument record;
    auto output = make<Output>(node, record);
    session_.outputs.push_back({text_of(node, "type", ""), std::move(output)});
    return record;
  };
  add(ConfigNode::parse("type: tables", "the outputs of a run"));
  if (file_.output.overlay) add(ConfigNode::parse("type: overlay", "the outputs of a run"));
  const ConfigNode& also = file_.output.also;
  if (!also.defined()) return;
  std::vector<YamlDocument> records;
  for (std::size_t i = 0; i < (also.is_list() ? also.size() : 1); ++i)
    records.push_back(add(also.is_list() ? also.at(i) : also));
  YamlDocument output(dump_params(file_.output));
  output.set_list("also", records);
  record_.set("output", output);
}

/// Returns the comment of a protocol on what only the program that made the scene has.
std::string not_repeated(const std::vector<std::string>& taken) {
  if (taken.empty()) return {};
  return fmt::format(
      "# This file repeats the run only in a program that holds {}, as the one did that ran it.\n",
      fmt::join(taken, ", "));
}

OpenedScene Opening::finish() {
  session_.parts.tile = file_.tile;
  session_.parts.evaluate = file_.evaluate;
  session_.parts.photometric = file_.photometric;
  session_.parts.search = file_.search;
  session_.parts.status = file_.status;
  session_.parts.one_euro = file_.output.smoothing;
  session_.parts.fixed_lag = file_.smoothing.fixed_lag;
  session_.parts.budget.evaluations = file_.budget.evaluations;
  if (file_.budget.seconds > 0) session_.parts.budget.seconds = file_.budget.seconds;
  if (file_.budget.cpu_seconds > 0) {
    if (file_.budget.seconds > 0)
      detail::fail_at(
          root_.get("budget").get("cpu_seconds"),
          "the budget has `seconds` of wall time too; give one of them, 0 for the other");
    session_.parts.budget.seconds = file_.budget.cpu_seconds;
    session_.parts.clock = SearchClock::cpu;
  }
  session_.init = file_.init;
  session_.output = file_.output;
  session_.shape = file_.shape;
  session_.seed = static_cast<std::uint64_t>(file_.seed);
  session_.resolved = not_repeated(plugins_->taken_from_program()) + record_.text();
  return std::move(session_);
}

}  // namespace

OpenedScene open_scene(const SceneInput& scene, std::span<const std::string> overrides,
                       PluginLoader& plugins) {
  Opening opening(load_scene(scene, overrides), plugins);
  opening.tracker();
  opening.images();
  opening.source();
  opening.outputs();
  return opening.finish();
}

OpenedScene open_scene(const SceneInput& scene, std::span<const std::string> overrides,
                       PluginLoader& plugins, std::unique_ptr<Source> source,
                       const std::string& source_resolved) {
  Opening opening(load_scene(scene, overrides), plugins);
  opening.tracker();
  opening.images();
  opening.source(std::move(source), source_resolved);
  opening.outputs();
  return opening.finish();
}

OpenedScene open_without_source(const SceneInput& scene, std::span<const std::string> overrides,
                                PluginLoader& plugins) {
  Opening opening(load_scene(scene, overrides), plugins);
  opening.tracker();
  return opening.finish();
}

OpenedScene open_source(const SceneInput& scene, std::span<const std::string> overrides,
                        PluginLoader& plugins) {
  Opening opening(load_scene(scene, overrides), plugins);
  opening.models();
  opening.source();
  return opening.finish();
}

std::unique_ptr<FixedLagSmoother> make_fixed_lag_smoother(const OpenedScene& session) {
  const TrackerParts& parts = session.parts;
  if (!parts.fixed_lag.enabled) return nullptr;
  if (parts.status.uncertainty.enabled)
    throw ConfigError(
        "smoothing.fixed_lag.enabled and uncertainty.enabled are both on, but sigmas are "
        "of states as they were found; switch one of them off");
  return std::make_unique<FixedLagSmoother>(
      *session.scene, parts.objective, parts.evaluate, parts.fixed_lag,
      parts.photometric.match && parts.photometric.highlights);
}

}  // namespace hypotrack::internal
