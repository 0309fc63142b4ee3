#include "lab/study/study_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "base/numbers.hpp"
#include "config/file_name.hpp"
#include "config/read_value.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/text.hpp"
#include "lab/study/study_grid.hpp"
#include "output/metrics/metrics.hpp"

namespace hypotrack::study::internal {
namespace {

/// The variant that every study has, for a look within minutes.
inline constexpr std::string_view kQuick = "quick";

constexpr int kFrames = 10;
constexpr std::size_t kQuickSeeds = 2;

/// Reduces a study to a few frames and seeds and to the ends of its axes of values. A study's own
/// variant of this name then changes what is not quick or not enough.
void make_quick(Study& study) {
  study.frames = std::min(study.frames.value_or(kFrames), kFrames);
  study.seeds.resize(std::min(study.seeds.size(), kQuickSeeds));
  for (Axis& axis : study.axes)
    if (axis.is_key && axis.choices.size() > 2)
      axis.choices.erase(axis.choices.begin() + 1, axis.choices.end() - 1);
}

using detail::fail_at;
using detail::fail_type;

constexpr std::int64_t kMaxSeeds = 10'000;

/// The keys of a study file.
struct StudyKeys {
  std::string title, about, extends;
  ConfigNode scenes, set, grid, seeds, variants;
  std::optional<int> frames;
  bool overlay = false, recordings = false, trace = false;
  Redraw redraw = Redraw::noise;
  std::vector<double> tolerances;
  std::vector<Plot> plots;
  std::string table_per;
  std::filesystem::path directory;
  void visit(ParamVisitor& v) {
    v("extends", extends, {.help = "another study, to which this one adds"});
    v("title", title, {.help = "heading of the report", .required = true});
    v("about", about, {.help = "one paragraph: what is compared and why"});
    v("scenes", scenes,
      {.help = "{NAME: {file, label, set: {key: value}}}: scene files and changes to them",
       .required = true});
    v("set", set, {.help = "{key: value}: changes to every scene"});
    v("grid", grid, {.help = "{key: [values]} or {AXIS: {CASE: {key: value}}}: all combinations"});
    v("seeds", seeds, {.help = "a number N for the seeds 1 to N, or a list of seeds"});
    v("frames", frames, {.help = "at most so many frames of each source", .min = 1});
    v("overlay", overlay, {.help = "whether every run writes overlay.mp4"});
    v("recordings", recordings,
      {.help = "whether every source is recorded once, and all runs read the recording"});
    v("redraw", redraw,
      {.help = "what seeds redraw of rendered pictures: noise, or nothing; all settings get the "
               "same pictures"});
    v("trace", trace, {.help = "whether every run writes trace.csv, how its searches converge"});
    v("tolerances", tolerances,
      {.help = "with trace: targets of the report, as shares of the cost at the truth above it",
       .min = 0});
    v("plots", plots, {.help = "list of {kind, x, y, value, color, facet, title, ...}"});
    v("table_per", table_per,
      {.help = "axis with a table of its own for each value: rows are compared within it"});
    v("variants", variants, {.help = "{NAME: {seeds, frames, scenes, set, grid, overlay}}"});
    v("directory", directory,
      {.help = "folder that relative paths in changes refer to; the study's own by default"});
  }
};

struct VariantKeys {
  ConfigNode set, grid, seeds;
  std::vector<std::string> scenes;
  std::optional<int> frames;
  std::optional<bool> overlay;
  void visit(ParamVisitor& v) {
    v("scenes", scenes, {.help = "names of the scenes to keep"});
    v("set", set, {.help = "{key: value}: further changes to every scene"});
    v("grid", grid, {.help = "other values for axes of the study"});
    v("seeds", seeds, {.help = "other seeds"});
    v("frames", frames, {.help = "at most so many frames of each source", .min = 1});
    v("overlay", overlay, {.help = "whether every run writes overlay.mp4"});
  }
};

struct SceneKeys {
  std::filesystem::path file;
  std::string label;
  ConfigNode set;
  void visit(ParamVisitor& v) {
    v("file", file, {.help = "scene file", .required = true});
    v("label", label, {.help = "how tables and plots call it"});
    v("set", set, {.help = "{key: value}: changes to the scene"});
  }
};

std::int64_t read_seed(const ConfigNode& node, std::int64_t lowest, std::int64_t highest) {
  const auto number =
      node.is_plain() ? detail::parse_integer(node.scalar()) : std::optional<std::int64_t>();
  if (!number || *number < lowest || *number > highest)
    fail_type(node, fmt::format("an integer from {} to {}", lowest, highest));
  return *number;
}

std::vector<std::int64_t> read_seeds(const ConfigNode& node) {
  std::vector<std::int64_t> seeds;
  if (!node.is_list()) {
    const std::int64_t count = read_seed(node, 1, kMaxSeeds);
    for (std::int64_t seed = 1; seed <= count; ++seed) seeds.push_back(seed);
    return seeds;
  }
  std::set<std::int64_t> known;
  for (std::size_t i = 0; i < node.size(); ++i) {
    seeds.push_back(read_seed(node.at(i), 0, std::numeric_limits<std::int64_t>::max()));
    if (!known.insert(seeds.back()).second)
      fail_at(node.at(i), fmt::format("the seed {} is there twice", seeds.back()));
  }
  if (seeds.empty()) fail_at(node, "at least one seed is needed");
  return seeds;
}

/// Returns the file of a scene: a path, or a reference such as `"@scenes/demo"`.
std::filesystem::path scene_file(const ConfigNode& node, const std::filesystem::path& path) {
  const std::string& text = node.scalar();
  if (text.starts_with('@'))
    return detail::find_file({text.substr(1), node.directory(), node.where()}, "scene");
  if (!std::filesystem::is_regular_file(path))
    fail_at(node, fmt::format("there is no scene file {}", path.string()));
  return path;
}

StudyScene read_scene(const ConfigNode& scenes, const std::string& name,
                      std::vector<Change> changes) {
  const ConfigNode node = scenes.get(name);
  if (!is_word(name))
    fail_at(node, "the name of a scene is a word of letters, digits, '_' and '-'");
  const auto keys = ParamReader(node).read<SceneKeys>();
  auto file = scene_file(node.get("file"), keys.file);
  add_changes(changes, read_changes(keys.set));
  return {name, std::move(file), keys.label.empty() ? name : keys.label, std::move(changes),
          scenes.where_key(name)};
}

/// The scenes, with `changes` to each of them before their own.
std::vector<StudyScene> read_scenes(const ConfigNode& node, const std::vector<Change>& changes) {
  if (!node.is_map() || node.size() == 0)
    fail_type(node, "a map with at least one scene, `{NAME: {file: scene.yaml}}`");
  std::vector<StudyScene> scenes;
  for (const std::string& name : node.keys()) scenes.push_back(read_scene(node, name, changes));
  return scenes;
}

template <class T>
std::vector<std::string> names_of(const std::vector<T>& items) {
  std::vector<std::string> names;
  for (const T& item : items) names.push_back(item.name);
  return names;
}

void keep_scenes(Study& study, const ConfigNode& variant, const std::vector<std::string>& kept) {
  const std::vector<std::string> names = names_of(study.scenes);
  for (std::size_t i = 0; i < kept.size(); ++i)
    if (std::find(names.begin(), names.end(), kept[i]) == names.end())
      fail_at(variant.get("scenes").at(i),
              fmt::format("'{}' is no scene of the study{}; its scenes are: {}", kept[i],
                          did_you_mean(kept[i], names), fmt::join(names, ", ")));
  std::erase_if(study.scenes, [&](const StudyScene& scene) {
    return std::find(kept.begin(), kept.end(), scene.name) == kept.end();
  });
}

void apply_variant(Study& study, const ConfigNode& node) {
  const auto variant = ParamReader(node).read<VariantKeys>();
  if (!variant.scenes.empty()) keep_scenes(study, node, variant.scenes);
  if (variant.grid.defined()) replace_choices(study.axes, variant.grid);
  if (variant.seeds.defined()) study.seeds = read_seeds(variant.seeds);
  if (variant.frames) study.frames = variant.frames;
  if (variant.overlay) study.overlay = *variant.overlay;
  const std::vector<Change> changes = read_changes(variant.set);
  for (StudyScene& scene : study.scenes) add_changes(scene.changes, changes);
}

/// Finds out what the changes include from other scenes.
void resolve_includes(Study& study) {
  std::map<std::string, std::string> contents;  // of assignments, which scenes share
  const auto take = [&](std::vector<Change>& changes) {
    for (Change& change : changes) {
      std::string& content = contents[change.assignment()];
      if (content.empty()) content = content_of(change, study.directory);
      change.content = content;
    }
  };
  for (StudyScene& scene : study.scenes) take(scene.changes);
  for (Axis& axis : study.axes)
    for (Choice& choice : axis.choices) take(choice.changes);
}

/// Every variant is read, so that a mistake in one is found before it is asked for.
void apply_variants(Study& study, const ConfigNode& variants, const std::string& file,
                    const std::optional<std::string>& name) {
  if (variants.defined() && !variants.is_map())
    fail_type(variants, "a map of variants, `{NAME: {seeds: 1, ...}}`");
  std::vector<std::string> names = variants.keys();
  for (const std::string& other : names) {
    Study copy = study;
    apply_variant(copy, variants.get(other));
    resolve_includes(copy);
  }
  if (!name) return;
  if (*name == kQuick) {
    make_quick(study);
    if (!variants.get(kQuick).defined()) return;
  }
  if (std::find(names.begin(), names.end(), kQuick) == names.end()) names.emplace_back(kQuick);
  if (std::find(names.begin(), names.end(), *name) == names.end())
    throw ConfigError(fmt::format("{}: has no variant '{}'{}; its variants are: {}", file, *name,
                                  did_you_mean(*name, names), fmt::join(names, ", ")));
  apply_variant(study, variants.get(*name));
}

/// Throws ConfigError unless a plot can draw it: a number of metrics.json or, of every run,
/// summary.json.
void check_metric(const ConfigNode& node, const std::string& name) {
  if (name.empty()) fail_at(node, "required key is missing: the metric to draw");
  std::vector<std::string> known = metric_names();
  known.insert(known.end(), {"uncertain_frames", "fps", "frame_seconds", "search_fps",
                             "evaluations_per_second"});
  if (std::find(known.begin(), known.end(), name) != known.end()) return;
  fail_at(node, fmt::format("'{}' is no metric of a run{}; there are: {}", name,
                            did_you_mean(name, known), fmt::join(known, ", ")));
}

/// Throws ConfigError unless the runs of a study have what a plot of how searches converge shows.
void check_traced(const Study& study, const Plot& plot, const ConfigNode& node) {
  if (!study.trace)
    fail_at(node, fmt::format("a plot of kind {} needs `trace: true` in the study",
                              enum_names(plot.kind)[static_cast<std::size_t>(plot.kind)]));
  const std::vector<std::string> known{"evaluations", "cpu_seconds", "wall_seconds"};
  if (!plot.x.empty() && std::find(known.begin(), known.end(), plot.x) == known.end())
    fail_at(node.get("x"),
            fmt::format("'{}' is nothing that a search spends{}; there are: {}", plot.x,
                        did_you_mean(plot.x, known), fmt::join(known, ", ")));
}

/// What varies must be there to be drawn over, and what is drawn must be a metric.
void check_plots(const Study& study, const ConfigNode& plots) {
  std::vector<std::string> known = names_of(study.axes);
  known.insert(known.end(), {"scene", "seed"});
  const auto check = [&](std::size_t i, const char* key, const std::string& name, bool required) {
    const ConfigNode node = plots.at(i).get(key);
    if (name.empty() && required) fail_at(node, "required key is missing");
    if (!name.empty() && std::find(known.begin(), known.end(), name) == known.end())
      fail_at(node, fmt::format("'{}' is nothing that varies in this study{}; there are: {}", name,
                                did_you_mean(name, known), fmt::join(known, ", ")));
  };
  for (std::size_t i = 0; i < study.plots.size(); ++i) {
    const Plot& plot = study.plots[i];
    const bool heatmap = plot.kind == PlotKind::heatmap;
    if (needs_trace(plot.kind))
      check_traced(study, plot, plots.at(i));
    else
      check(i, "x", plot.x, plot.kind != PlotKind::success);
    check(i, "color", plot.color, false);
    check(i, "facet", plot.facet, false);
    if (heatmap) check(i, "y", plot.y, true);
    if (heatmap) check_metric(plots.at(i).get("value"), plot.value);
    if (plot.kind == PlotKind::curve || plot.kind == PlotKind::bars)
      check_metric(plots.at(i).get("y"), plot.y);
  }
}

void check_table_per(const Study& study, const ConfigNode& node) {
  const std::vector<std::string> known = names_of(study.axes);
  if (study.table_per.empty() ||
      std::find(known.begin(), known.end(), study.table_per) != known.end())
    return;
  fail_at(node, fmt::format("'{}' is no axis of this study{}; there are: {}", study.table_per,
                            did_you_mean(study.table_per, known), fmt::join(known, ", ")));
}

}  // namespace

std::span<const std::string_view> enum_names(Redraw) {
  static constexpr std::array<std::string_view, 2> kNames = {"noise", "nothing"};
  return kNames;
}

std::span<const std::string_view> enum_names(PlotKind) {
  static constexpr std::array<std::string_view, 9> names{"curve",
                                                         "success",
                                                         "heatmap",
                                                         "bars",
                                                         "convergence",
                                                         "targets",
                                                         "performance_profile",
                                                         "data_profile",
                                                         "expected_running_time"};
  return names;
}

bool needs_trace(PlotKind kind) { return kind >= PlotKind::convergence; }

void Plot::visit(ParamVisitor& v) {
  v("kind", kind,
    {.help = "curve: a metric over an axis; success: share of frames below an error; heatmap: a "
             "metric over two axes; bars: a metric of each case; with trace, convergence: the "
             "cost over evaluations; targets, performance_profile, data_profile, "
             "expected_running_time: what targets take",
     .required = true});
  v("x", x, {.help = "axis along x; with trace: evaluations, cpu_seconds or wall_seconds"});
  v("y", y, {.help = "metric along y (heatmap: an axis)"});
  v("value", value, {.help = "metric of a heatmap"});
  v("color", color, {.help = "axis that tells lines or bars apart"});
  v("facet", facet, {.help = "axis with a plot of its own for each value"});
  v("title", title, {.help = "heading"});
  v("x_label", x_label, {.help = "text along x"});
  v("y_label", y_label, {.help = "text along y"});
}

Study load_study(const std::filesystem::path& file, const std::optional<std::string>& variant) {
  const ConfigNode root = ConfigNode::load_study(file);
  if (!root.is_map()) fail_type(root, "a study: a map with title, scenes, grid, ...");
  if (root.get("models").defined() && !root.get("scenes").defined())
    throw ConfigError(
        fmt::format("{}: this is a scene, no study: it has `models`; `hypotrack run` tracks it",
                    file.string()));
  const auto keys = ParamReader(root).read<StudyKeys>();
  Study study;
  study.title = keys.title;
  study.about = keys.about;
  study.scenes = read_scenes(keys.scenes, read_changes(keys.set));
  study.axes = read_grid(keys.grid);
  study.seeds = keys.seeds.defined() ? read_seeds(keys.seeds) : std::vector<std::int64_t>{1};
  study.frames = keys.frames;
  study.overlay = keys.overlay;
  study.recordings = keys.recordings;
  study.redraw = keys.redraw;
  study.trace = keys.trace;
  study.tolerances = keys.tolerances;
  study.plots = keys.plots;
  study.table_per = keys.table_per;
  study.directory = keys.directory.empty() ? root.directory() : keys.directory;
  if (!keys.directory.empty() && !std::filesystem::is_directory(keys.directory))
    fail_at(root.get("directory"), fmt::format("there is no folder {}", keys.directory.string()));
  check_plots(study, root.get("plots"));
  check_table_per(study, root.get("table_per"));
  apply_variants(study, keys.variants, file.string(), variant);
  resolve_includes(study);
  return study;
}

}  // namespace hypotrack::study::internal
