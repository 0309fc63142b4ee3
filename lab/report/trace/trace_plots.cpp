#include "lab/report/trace/trace_plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "lab/json_file.hpp"
#include "lab/report/trace/frame_curve.hpp"

namespace hypotrack::internal {
namespace {

constexpr int kPlaces = 80;  // along a line
constexpr double kNotReached = std::numeric_limits<double>::infinity();

/// The curves of some runs that are compared as one: a solver.
struct Solver {
  Json color;  ///< value that names it; null: there is only one
  std::vector<std::pair<std::string, const FrameCurve*>> frames;  ///< with the problem of each
};

/// A range of positive numbers.
struct Range {
  double lowest = kNotReached, highest = 0;
  void add(double number) {
    if (!(number > 0) || !std::isfinite(number)) return;
    lowest = std::min(lowest, number);
    highest = std::max(highest, number);
  }
  std::vector<double> places() const {
    return highest > 0 ? geometric_places(lowest, highest, kPlaces) : std::vector<double>();
  }
};

TraceCost cost_of(const std::string& x) {
  if (x == "cpu_seconds") return TraceCost::cpu_seconds;
  return x == "wall_seconds" ? TraceCost::wall_seconds : TraceCost::evaluations;
}

std::string label_of(TraceCost over) {
  constexpr std::array kLabels{"evaluations of a frame", "CPU time of a frame (s)",
                               "wall time of a frame (s)"};
  return kLabels[static_cast<std::size_t>(over)];
}

/// Returns what a run has in common with those of other solvers on the same problems.
std::string problem_of(const StudyData& study, const StudyRun& run, const std::string& color) {
  std::string text = color == "scene" ? "" : run.scene;
  for (const StudyAxis& axis : study.axes)
    if (axis.key != color) text += "\n" + run.on_axis(axis.key);
  return color == "seed" ? text : text + fmt::format("\n{}", run.seed);
}

std::string target_label(double tolerance) {
  return fmt::format("within {:g} % of the truth's cost", 100 * tolerance);
}

/// Makes the panels of one plot.
class Panels {
 public:
  Panels(const StudyData& study, const PlotRequest& request, const Runs& runs)
      : study_(study), request_(request), over_(cost_of(request.x)) {
    for (const StudyRun* run : runs)
      if (has_trace(*run)) {
        traced_.push_back(run);
        curves_[run] = read_curves(run->directory / "trace.csv", over_);
      }
    known_ = std::ranges::all_of(curves_, [](const auto& of_run) {
      return std::ranges::all_of(of_run.second, [](const FrameCurve& curve) {
        return curve.steps.empty() || !std::isnan(curve.steps.back().excess);
      });
    });
  }

  /// Returns whether the truth is known in all frames.
  bool knows_truth() const { return known_; }
  TraceCost over() const { return over_; }

  Json all() {
    Json facets = Json::array();
    if (request_.kind == "convergence" || request_.kind == "expected_running_time") {
      for_each_facet([&](const std::string& label, const std::vector<Solver>& solvers) {
        if (request_.kind == "convergence")
          facets.push_back({{"label", label}, {"rows", convergence(solvers)}});
        else if (known_)
          facets.push_back({{"label", label}, {"rows", running_times(solvers)}});
      });
      return facets;
    }
    if (!known_) return facets;
    const std::vector<Profile> profiles = this->profiles();
    Range range;  // of all panels, so that their lines end where the axes do
    for (const Profile& profile : profiles)
      for (const auto& numbers : profile.numbers)
        for (const double number : numbers) range.add(number);
    for (const Profile& profile : profiles)
      facets.push_back({{"label", profile.label}, {"rows", rows_of(profile, range.places())}});
    return facets;
  }

 private:
  /// What solvers needed on their problems, in one panel.
  struct Profile {
    std::string label;
    std::vector<Solver> solvers;
    std::vector<std::vector<double>> numbers;  ///< by solver
  };

  void for_each_facet(
      const std::function<void(const std::string&, const std::vector<Solver>&)>& use) const {
    if (traced_.empty()) return;
    for_each_value(study_, traced_, request_.facet,
                   [&](const std::string& facet, const Runs& runs) {
                     use(facet_label(study_, request_.facet, facet), solvers_of(runs));
                   });
  }

  std::vector<Profile> profiles() const {
    std::vector<Profile> out;
    for_each_facet([&](const std::string& label, const std::vector<Solver>& solvers) {
      const std::string start = label.empty() ? "" : label + ", ";
      Profile joined{start + "all targets", solvers,
                     std::vector<std::vector<double>>(solvers.size())};
      for (const double tolerance : study_.tolerances) {
        out.push_back({start + target_label(tolerance), solvers, measured(solvers, tolerance)});
        const auto& numbers = out.back().numbers;
        for (std::size_t s = 0; s < numbers.size(); ++s)
          joined.numbers[s].insert(joined.numbers[s].end(), numbers[s].begin(), numbers[s].end());
      }
      if (request_.kind == "targets" && study_.tolerances.size() > 1)
        out.push_back(std::move(joined));
    });
    return out;
  }

  static Json rows_of(const Profile& profile, const std::vector<double>& places) {
    Json rows = Json::array();
    for (std::size_t s = 0; s < profile.solvers.size(); ++s)
      for (const double x : places)
        rows.push_back(row(profile.solvers[s], x, 100 * share_within(profile.numbers[s], x),
                           profile.numbers[s].size()));
    return rows;
  }

  std::vector<Solver> solvers_of(const Runs& runs) const {
    std::vector<Solver> solvers;
    for_each_value(study_, runs, request_.color, [&](const std::string& color, const Runs& same) {
      Solver solver;
      if (!request_.color.empty()) solver.color = value_json(study_, request_.color, color);
      for (const StudyRun* run : same) {
        const std::string problem = problem_of(study_, *run, request_.color);
        for (const FrameCurve& curve : curves_.at(run))
          solver.frames.emplace_back(fmt::format("{}\n{}", problem, curve.frame), &curve);
      }
      solvers.push_back(std::move(solver));
    });
    return solvers;
  }

  static Json row(const Solver& solver, double x, double value, std::size_t n) {
    Json row;
    if (!solver.color.is_null()) row["color"] = solver.color;
    row["x"] = x;
    row["mean"] = value;
    row["n"] = n;
    return row;
  }

  Json convergence(const std::vector<Solver>& solvers) const {
    Range range;
    for (const Solver& solver : solvers)
      for (const auto& [problem, curve] : solver.frames) {
        if (!curve->steps.empty()) range.add(curve->steps.front().spent);
        range.add(curve->spent);
      }
    Json rows = Json::array();
    for (const Solver& solver : solvers)
      for (const double x : range.places()) {
        std::vector<double> values;
        for (const auto& [problem, curve] : solver.frames)
          if (const CurveStep* step = curve->at(x))
            values.push_back(known_ ? 100 * step->excess : step->cost);
        const auto found = quartiles(values);
        if (!found) continue;
        Json one = row(solver, x, found->median, values.size());
        one["lo"] = found->lower;
        one["hi"] = found->upper;
        rows.push_back(std::move(one));
      }
    return rows;
  }

  /// Returns the numbers whose distribution a profile shows, for each solver; infinite where a
  /// target was not reached.
  std::vector<std::vector<double>> measured(const std::vector<Solver>& solvers,
                                            double tolerance) const {
    std::vector<std::vector<double>> out(solvers.size());
    if (request_.kind == "performance_profile") {
      std::map<std::string, std::vector<Trial>> problems;
      for (std::size_t s = 0; s < solvers.size(); ++s)
        for (const auto& [problem, curve] : solvers[s].frames) {
          auto& trials = problems[problem];
          trials.resize(solvers.size());
          trials[s] = curve->towards(tolerance);
        }
      for (const auto& [problem, trials] : problems) {
        const std::vector<double> ratios = performance_ratios(trials);
        for (std::size_t s = 0; s < solvers.size(); ++s) out[s].push_back(ratios[s]);
      }
      return out;
    }
    const bool simplex = request_.kind == "data_profile";
    for (std::size_t s = 0; s < solvers.size(); ++s)
      for (const auto& [problem, curve] : solvers[s].frames) {
        const Trial trial = curve->towards(tolerance);
        const double spent = trial.reached ? trial.spent : kNotReached;
        out[s].push_back(simplex ? simplex_gradients(trial, curve->dimension) : spent);
      }
    return out;
  }

  Json running_times(const std::vector<Solver>& solvers) const {
    Json rows = Json::array();
    for (const Solver& solver : solvers)
      for (const double tolerance : study_.tolerances) {
        std::vector<Trial> trials;
        for (const auto& [problem, curve] : solver.frames)
          trials.push_back(curve->towards(tolerance));
        const double expected = expected_running_time(trials);
        if (std::isfinite(expected))
          rows.push_back(row(solver, 100 * tolerance, expected, trials.size()));
      }
    return rows;
  }

  const StudyData& study_;
  const PlotRequest& request_;
  TraceCost over_;
  Runs traced_;
  std::map<const StudyRun*, std::vector<FrameCurve>> curves_;
  bool known_ = false;
};

struct Texts {
  std::string title, x, y, note;
  int digits = 1;
  const char* y_scale = "linear";
};

Texts texts_of(const std::string& kind, const Panels& panels) {
  const std::string over = label_of(panels.over());
  if (kind == "convergence")
    return {"Convergence",
            over,
            panels.knows_truth() ? "cost above that of the truth (%)" : "lowest cost so far",
            "Median and quartiles over frames and seeds of the lowest cost so far. A search that "
            "has ended keeps its cost.",
            panels.knows_truth() ? 1 : 4,
            panels.knows_truth() ? "symlog" : "linear"};
  if (kind == "targets")
    return {"Targets reached", over, "share of frames (%)",
            "Empirical distribution, over frames and seeds, of what it takes to reach a target."};
  if (kind == "performance_profile")
    return {"Performance profiles", "factor of the fastest", "share of frames (%)",
            "Share of frames and seeds in which a target was reached within a factor of what the "
            "fastest needed (Moré and Wild 2009)."};
  if (kind == "data_profile")
    return {"Data profiles", "simplex gradients: spent / (dimensions + 1)", "share of frames (%)",
            "Share of frames and seeds in which a target was reached within a number of simplex "
            "gradients (Moré and Wild 2009)."};
  return {"Expected running time",
          "target: cost above that of the truth (%)",
          over,
          "What all frames spent until the target, over the number that reached it (ERT of COCO, "
          "Hansen et al. 2021). No point: none did.",
          0,
          "log"};
}

}  // namespace

bool is_traced(std::string_view kind) {
  constexpr std::array<std::string_view, 5> kKinds{"convergence", "targets", "performance_profile",
                                                   "data_profile", "expected_running_time"};
  return std::ranges::find(kKinds, kind) != kKinds.end();
}

bool has_trace(const StudyRun& run) { return std::filesystem::exists(run.directory / "trace.csv"); }

Json traced_plot(const StudyData& study, const PlotRequest& request, const Runs& runs) {
  Panels panels(study, request, runs);
  const Texts texts = texts_of(request.kind, panels);
  const auto or_default = [](const std::string& given, const std::string& text) {
    return given.empty() ? text : given;
  };
  return {{"title", or_default(request.title, texts.title)},
          {"note", texts.note},
          {"counted", "frames"},
          {"x", {{"label", or_default(request.x_label, texts.x)}, {"scale", "log"}}},
          {"y", {{"label", or_default(request.y_label, texts.y)}, {"scale", texts.y_scale}}},
          {"value", {{"label", texts.y}, {"digits", texts.digits}}},
          {"color", dimension(study, request.color, "")},
          {"facets", panels.all()}};
}

}  // namespace hypotrack::internal
