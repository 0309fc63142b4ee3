#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/exported.hpp"
#include "cost/cost.hpp"
#include "hypotrack/api/config.hpp"
#include "hypotrack/plugin/params.hpp"
#include "session/shape_settings.hpp"
#include "tile/tiles.hpp"
#include "track/color/photometric.hpp"
#include "track/one_euro.hpp"
#include "track/search/search_space.hpp"
#include "track/smooth/fixed_lag_settings.hpp"
#include "track/status.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// The starter that takes its parameters from `init.file` and `init.frame`.
inline constexpr std::string_view kStartFromFile = "file";

/// The starter that takes its file from `init.file`.
inline constexpr std::string_view kStartFromClicks = "clicks";

/// The word in `init.from` for the starters of configs/starters/auto.yaml that can be used.
inline constexpr std::string_view kStartAuto = "auto";

/// `init:` of a scene.
struct InitSettings {
  ConfigNode from = ConfigNode::parse("rest", "the default of init.from");
  std::filesystem::path file;
  int frame = 0;
  ConfigNode pose;
  double away = 0;         ///< m
  double away_turn = 0;    ///< rad
  double away_angles = 0;  ///< rad
  void visit(ParamVisitor& v) {
    v("from", from,
      {.help =
           "start of the first search: the name of a starter (rest, truth, file, clicks, "
           "global_search or another) or {type, ...}; a list of starters that look for the "
           "models, tried in this order; or auto: those of configs/starters/auto.yaml that can"});
    v("file", file,
      {.help = "for from: file: a pose (YAML, written like init.pose) or a state table (CSV, a "
               "track.csv for example); for from: clicks: landmarks marked in both views (YAML)"});
    v("frame", frame, {.help = "which frame of the table", .min = 0});
    v("pose", pose,
      {.help = "what to change about that state: {MODEL: {position_mm, rotation_deg, quaternion or "
               "rotation, angles_deg: {NAME: VALUE}, lengths_mm: {NAME: VALUE}}}"});
    v("away_mm", away,
      {.help =
           "moves every model of that state this far, in a direction that the seed decides: how "
           "far off may a start be?",
       .min = 0,
       .max = 1e4,
       .unit = "mm",
       .to_si = kMillimetre});
    v("away_deg", away_turn,
      {.help = "turns every model of that state by this, about an axis that the seed decides",
       .min = 0,
       .max = 180,
       .unit = "deg",
       .to_si = kDegree});
    v("away_angles_deg", away_angles,
      {.help = "changes every joint angle of that state by a normal sample of this standard "
               "deviation, within the model's bounds",
       .min = 0,
       .max = 180,
       .unit = "deg",
       .to_si = kDegree});
  }
};

/// Returns the maps, each with a `type`, that starters are made from: `from` (of `init` or of
/// `recovery`), or what its words stand for. `written` is the scene's `init`.
std::vector<ConfigNode> starter_nodes(const ConfigNode& from, const ConfigNode& written);

/// The judge of scenes that name none, and the word for none.
inline constexpr std::string_view kUsualJudge = "network";
inline constexpr std::string_view kNoJudge = "none";

/// `budget:` of a scene.
struct BudgetSettings {
  std::int64_t evaluations = 0;
  double seconds = 0;
  double cpu_seconds = 0;
  void visit(ParamVisitor& v) {
    v("evaluations", evaluations,
      {.help = "evaluations per frame; 0: what the optimizer's parameters imply", .min = 0});
    v("seconds", seconds,
      {.help = "wall time per frame; 0: no limit; a run with a limit does not repeat exactly",
       .min = 0,
       .unit = "s"});
    v("cpu_seconds", cpu_seconds,
      {.help = "CPU time per frame, of all threads, instead of wall time; 0: no limit",
       .min = 0,
       .unit = "s"});
  }
};

/// `output:` of a scene.
struct OutputSettings {
  bool overlay = true;
  int worst_frames = 3;
  bool trace = false;
  ConfigNode also;
  OneEuroSettings smoothing;
  void visit(ParamVisitor& v) {
    v("overlay", overlay, {.help = "write overlay.mp4, the solution drawn on the first view"});
    v("worst_frames", worst_frames,
      {.help = "with ground truth, draw the solution and the truth at up to this many frames of "
               "largest error (worst_<frame>.jpg)",
       .min = 0,
       .max = 100});
    v("trace", trace,
      {.help = "write trace.csv, how the searches of every frame converged, batch by batch"});
    v("also", also, {.help = "further outputs: {type, ...}, or a list of them"});
    v("smoothing", smoothing, {.help = "how states are smoothed before they are written"});
  }
};

/// `smoothing:` of a scene.
struct SmoothingSettings {
  FixedLagSettings fixed_lag;
  void visit(ParamVisitor& v) {
    v("fixed_lag", fixed_lag, {.help = "smoothing of a window of frames at once"});
  }
};

/// The keys of a scene. Plugins' parameters stay nodes until the plugin reads them.
struct SceneFile {
  ConfigNode models, source, objective, optimizer;
  BudgetSettings budget;
  TileSettings tile;
  EvaluateSettings evaluate;
  PhotometricSettings photometric;
  SearchSettings search;
  ConfigNode judge = ConfigNode::parse(kUsualJudge, "the default of judge");
  StatusSettings status;
  ConfigNode tracker;  ///< undefined: its file's keys are in the others
  SmoothingSettings smoothing;
  ShapeEstimateSettings shape;
  InitSettings init;
  OutputSettings output;
  std::int64_t seed = 1;
  void visit(ParamVisitor& v) {
    v("models", models,
      {.help = "list of {name, type, ...}: the tracked models", .required = true});
    v("source", source,
      {.help = "{type, ...}: the source of frames; a program with frames of its own needs none"});
    v("objective", objective,
      {.help = "{type, ...}, or a list of {type, weight, ...}: what is minimised",
       .required = true});
    v("optimizer", optimizer, {.help = "{type, ...}: how it is minimised", .required = true});
    v("budget", budget, {.help = "what the search of a frame may cost"});
    v("tile", tile, {.help = "the piece of each view that is looked at"});
    v("evaluate", evaluate, {.help = "how hypotheses are evaluated"});
    v("photometric", photometric, {.help = "how the views' colours are brought together"});
    v("search", search,
      {.help = "where the next solution is expected, and how far from there it may be"});
    v("judge", judge,
      {.help = "the name of a judge or {type, ...}: who says from the pictures whether a pose is "
               "right; none: solutions are judged by their costs, without recovery"});
    v("tracker", tracker,
      {.help = "\"@trackers/NAME\": a file that has the keys from objective to uncertainty"});
    v("status", status, {.help = "when models count as tracked, uncertain or lost"});
    v("recovery", status.recovery, {.help = "how lost models are found again"});
    v("uncertainty", status.uncertainty, {.help = "how far off each landmark may be"});
    v("smoothing", smoothing,
      {.help = "correction of states by later frames, before they are written"});
    v("shape", shape, {.help = "estimation of the models' shapes"});
    v("init", init, {.help = "start of the first search"});
    v("output", output, {.help = "what a run writes"});
    v("seed", seed, {.help = "of all random numbers", .min = 0});
  }
};

/// A scene file and the node from which plugins are made.
struct LoadedScene {
  SceneFile file;
  ConfigNode root;
  std::vector<std::string> notes = {};  ///< for the user: keys that have another name now
};

/// A scene before it is opened: a file, which is read every time, or a document of a program.
class SceneInput {
 public:
  SceneInput(std::filesystem::path file) : file_(std::move(file)) {}
  SceneInput(ConfigNode document) : document_(std::move(document)) {}

  /// Returns the scene with its references and the overrides; `notes` gets lines on former keys.
  /// Throws ConfigError.
  ConfigNode read(std::span<const std::string> overrides, std::vector<std::string>* notes) const {
    return document_ ? document_->as_scene(overrides, notes)
                     : ConfigNode::load_scene(file_, overrides, notes);
  }
  /// Returns the file; empty for a document.
  const std::filesystem::path& file() const { return file_; }

 private:
  std::filesystem::path file_;
  std::optional<ConfigNode> document_;
};

/// Reads a scene and applies the overrides. Throws ConfigError, also on unknown keys.
LoadedScene load_scene(const SceneInput& input, std::span<const std::string> overrides);

}  // namespace internal
}  // namespace hypotrack
