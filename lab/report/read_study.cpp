#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <tuple>

#include "hypotrack/api/config.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/params.hpp"
#include "lab/report/study_data.hpp"
#include "output/run_directory.hpp"

namespace hypotrack::internal {
namespace {

namespace fs = std::filesystem;

std::string text_of(const ConfigNode& map, const char* key) {
  const ConfigNode node = map.get(key);
  return node.is_scalar() && !node.is_null() ? node.scalar() : std::string();
}

/// Labels axes by the last part of their keys; by the whole key where two axes end alike.
void label_axes(std::vector<StudyAxis>& axes) {
  const auto last_part = [](const std::string& key) { return key.substr(key.rfind('.') + 1); };
  for (StudyAxis& axis : axes) {
    const auto alike = std::count_if(axes.begin(), axes.end(), [&](const StudyAxis& other) {
      return last_part(other.key) == last_part(axis.key);
    });
    axis.label = alike == 1 ? last_part(axis.key) : axis.key;
    std::replace(axis.label.begin(), axis.label.end(), '_', ' ');
  }
}

StudyAxis read_axis(const std::string& key, const ConfigNode& values) {
  StudyAxis axis{.key = key};
  if (values.is_map()) axis.values = values.keys();  // named cases
  for (std::size_t i = 0; values.is_list() && i < values.size(); ++i)
    axis.values.push_back(
        canonical_value(values.at(i).is_scalar() ? values.at(i).scalar() : values.at(i).to_yaml()));
  return axis;
}

void read_plots(const ConfigNode& plots, std::vector<PlotRequest>& requests) {
  for (std::size_t i = 0; i < plots.size(); ++i) {
    const ConfigNode plot = plots.at(i);
    requests.push_back({.kind = text_of(plot, "kind"),
                        .x = text_of(plot, "x"),
                        .y = text_of(plot, "y"),
                        .value = text_of(plot, "value"),
                        .color = text_of(plot, "color"),
                        .facet = text_of(plot, "facet"),
                        .title = text_of(plot, "title"),
                        .x_label = text_of(plot, "x_label"),
                        .y_label = text_of(plot, "y_label")});
  }
}

void read_tolerances(const ConfigNode& list, std::vector<double>& tolerances) {
  if (!list.is_list()) return;
  tolerances.clear();
  for (std::size_t i = 0; i < list.size(); ++i)
    if (double number = 0; list.at(i).is_scalar() && parse_number(list.at(i).scalar(), number))
      tolerances.push_back(number);
}

std::size_t seeds_of(const ConfigNode& seeds) {
  constexpr double kMost = 10'000;  // as in study files
  if (seeds.is_list()) return seeds.size();
  double count = 1;
  const bool given = seeds.is_scalar() && parse_number(seeds.scalar(), count);
  return given && count >= 1 && count <= kMost ? static_cast<std::size_t>(count) : 1;
}

void read_study_file(const fs::path& file, StudyData& study) {
  const ConfigNode root = ConfigNode::load(file);
  study.title = text_of(root, "title");
  study.about = text_of(root, "about");
  const ConfigNode scenes = root.get("scenes");
  for (const std::string& name : scenes.keys()) {
    const std::string label = text_of(scenes.get(name), "label");
    study.scenes.push_back({name, label.empty() ? name : label});
  }
  const ConfigNode grid = root.get("grid");
  study.planned = study.scenes.size() * seeds_of(root.get("seeds"));
  for (const std::string& key : grid.keys()) {
    study.axes.push_back(read_axis(key, grid.get(key)));
    study.planned *= study.axes.back().values.size();
  }
  study.table_per = text_of(root, "table_per");
  read_tolerances(root.get("tolerances"), study.tolerances);
  read_plots(root.get("plots"), study.plots);
}

/// Reads the names of a study's runs; empty if it has no plan.
std::set<std::string> read_plan(const fs::path& file) {
  std::set<std::string> names;
  if (!fs::is_regular_file(file)) return names;
  std::ifstream in(file);
  for (std::string name; std::getline(in, name);) names.insert(name);
  return names;
}

/// Reads the runs of the study's plan; without a plan, all that are there.
void read_runs(const fs::path& directory, StudyData& study) {
  const std::set<std::string> plan = read_plan(directory / "plan.txt");
  if (!fs::is_directory(directory / "runs")) return;
  for (const auto& entry : fs::directory_iterator(directory / "runs")) {
    const std::string name = entry.path().filename().string();
    const bool is_run = plan.empty()
                            ? !name.starts_with(".") && fs::exists(entry.path() / "cell.json")
                            : plan.contains(name);
    if (is_run) study.runs.push_back(read_study_run(entry.path()));
  }
}

/// Adds scenes, axes and values that runs have and study.yaml does not name, at the end.
void add_what_runs_say(StudyData& study) {
  const auto add_once = [](std::vector<std::string>& values, const std::string& value) {
    if (std::find(values.begin(), values.end(), value) == values.end()) values.push_back(value);
  };
  for (const StudyRun& run : study.runs) {
    const bool known =
        std::any_of(study.scenes.begin(), study.scenes.end(),
                    [&](const StudyScene& scene) { return scene.name == run.scene; });
    if (!known) study.scenes.push_back({run.scene, run.scene});
    for (const auto& [key, value] : run.settings) {
      if (!study.axis(key)) study.axes.push_back({.key = key});
      for (StudyAxis& axis : study.axes)
        if (axis.key == key) add_once(axis.values, value);
    }
  }
  for (StudyAxis& axis : study.axes) {
    double ignored = 0;
    axis.numeric = !axis.values.empty() && std::all_of(axis.values.begin(), axis.values.end(),
                                                       [&](const std::string& value) {
                                                         return parse_number(value, ignored);
                                                       });
  }
  label_axes(study.axes);
}

void sort_runs(StudyData& study) {
  const auto place = [&](const StudyRun& run) {
    std::vector<std::ptrdiff_t> places;
    const auto add = [&](const std::string& key) {
      const auto values = study.values_of(key);
      places.push_back(std::find(values.begin(), values.end(), run.on_axis(key)) - values.begin());
    };
    add("scene");
    for (const StudyAxis& axis : study.axes) add(axis.key);
    places.push_back(run.seed);
    return std::make_tuple(std::move(places), run.id);
  };
  std::sort(study.runs.begin(), study.runs.end(),
            [&](const StudyRun& a, const StudyRun& b) { return place(a) < place(b); });
}

StudyData single_run(const fs::path& directory) {
  StudyData study;
  study.title = fs::canonical(directory).filename().string();
  study.planned = 1;
  StudyRun run;
  run.id = study.title;
  read_results(directory, run);
  study.runs.push_back(std::move(run));
  return study;
}

}  // namespace

StudyData read_study(const fs::path& directory) {
  if (!fs::is_directory(directory))
    throw DataError(fmt::format(
        "{}: no such folder; expected a study folder (of `hypotrack compare`) or a run folder (of "
        "`hypotrack run`)",
        directory.string()));
  if (!fs::exists(directory / "study.yaml")) {
    if (fs::exists(directory / "track.csv") && fs::exists(directory / "run.yaml")) {
      expect_finished_run(directory);
      return single_run(directory);
    }
    throw DataError(
        fmt::format("{}: is neither a study folder (it has no study.yaml) nor a run folder (it "
                    "has no track.csv and run.yaml); expected what `hypotrack compare` or "
                    "`hypotrack run` wrote with --out",
                    directory.string()));
  }
  StudyData study;
  study.is_study = true;
  read_study_file(directory / "study.yaml", study);
  if (study.title.empty()) study.title = fs::canonical(directory).filename().string();
  read_runs(directory, study);
  if (study.runs.empty())
    throw DataError(
        fmt::format("{}: has no finished run in {}; run `hypotrack compare` on the study first",
                    directory.string(), (directory / "runs").string()));
  add_what_runs_say(study);
  sort_runs(study);
  return study;
}

}  // namespace hypotrack::internal
