#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/config.hpp"
#include "hypotrack/plugin/params.hpp"

namespace hypotrack::study {
inline namespace HYPOTRACK_EXPORTED internal {

/// One change to a scene, as for `--set`.
struct Change {
  std::string key;              ///< dotted path
  std::string value;            ///< YAML on one line
  std::string where;            ///< place in the study: `study.yaml:12:5`
  std::string content = value;  ///< the value, with its includes resolved
  std::string assignment() const { return key + "=" + value; }
  /// Returns the change with resolved content, independent of the names of the included files.
  std::string meaning() const { return key + "=" + content; }
};

/// A scene of a study: a scene file and the study's changes to it.
struct StudyScene {
  std::string name;
  std::filesystem::path file;  ///< absolute
  std::string label;
  std::vector<Change> changes;
  std::string where;
};

/// One value of an axis: a number or word under the axis's key, or a named case.
struct Choice {
  std::string label;
  bool is_number = false;
  std::vector<Change> changes;
};

/// One axis of the grid.
struct Axis {
  std::string name;
  bool is_key = true;  ///< the name is a key of a scene; otherwise the choices are named cases
  std::vector<Choice> choices;
};

enum class PlotKind {
  curve,
  success,
  heatmap,
  bars,
  convergence,
  targets,
  performance_profile,
  data_profile,
  expected_running_time
};
std::span<const std::string_view> enum_names(PlotKind);

/// Returns whether a plot shows how searches converge, which takes `trace: true`.
bool needs_trace(PlotKind kind);

/// One item of `plots:`, drawn by `hypotrack report`. `x`, `color` and `facet` are axes, `scene` or
/// `seed`; `y` and `value` are metrics. `x` of a plot that needs a trace is a column of trace.csv.
struct Plot {
  PlotKind kind = PlotKind::curve;
  std::string x, y, value, color, facet, title, x_label, y_label;
  void visit(ParamVisitor& v);
};

/// What the seeds of a study redraw, apart from the random numbers of the search.
enum class Redraw {
  noise,    ///< the noise of rendered pictures: a recording of each source for every seed
  nothing,  ///< one recording of each source for all seeds
};
std::span<const std::string_view> enum_names(Redraw);

/// A study: every scene at every point of the grid with every seed.
struct Study {
  std::string title, about;
  std::vector<StudyScene> scenes;
  std::vector<Axis> axes;
  std::vector<std::int64_t> seeds;
  std::optional<int> frames;  ///< of each run; empty: the whole source
  bool overlay = false;       ///< whether runs write overlay.mp4
  bool recordings = false;    ///< whether sources are recorded once, for all runs
  Redraw redraw = Redraw::noise;
  bool trace = false;              ///< whether runs write trace.csv
  std::vector<double> tolerances;  ///< targets of the report; empty: its defaults
  std::vector<Plot> plots;
  std::string table_per;            ///< axis with a separate table for each value; may be empty
  std::filesystem::path directory;  ///< absolute; base of relative paths in changes
};

/// Reads a study file and applies one of its variants. Throws ConfigError with file, line and
/// column.
Study load_study(const std::filesystem::path& file,
                 const std::optional<std::string>& variant = std::nullopt);

/// Returns the study as a study file without variants. load_study() reads the same study back.
std::string to_yaml(const Study& study);

/// Formats a node as YAML on one line: `{type: pso, particles: 32}`. It parses to the same node.
std::string to_flow(const ConfigNode& node);

/// Formats a text as a YAML scalar on one line, quoted if it would not stay a text otherwise.
std::string yaml_scalar(std::string_view text);

/// Returns whether a name of a scene, case or variant consists of letters, digits, '_' and '-', as
/// file names require.
bool is_word(std::string_view text);

}  // namespace internal
}  // namespace hypotrack::study
