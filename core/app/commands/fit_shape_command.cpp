#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/text_file.hpp"
#include "commands.hpp"
#include "hypotrack/api/error.hpp"
#include "interrupt.hpp"
#include "messages.hpp"
#include "plugin/plugin_notes.hpp"
#include "progress.hpp"
#include "session/opened_scene.hpp"
#include "shape/shape_estimate.hpp"

namespace hypotrack::app {
namespace {

struct FitShapeOptions {
  SceneOptions scene;
  std::filesystem::path out = "shape.yaml";
  std::optional<int> frames;
  std::string from = "images";
};

void print_estimate(const ShapeEstimate& e) {
  fmt::print("{:<12}{:>9}{:>10}{:>10}\n", "", "shape", "+-", "neutral");
  for (std::size_t i = 0; i < e.wanted.size(); ++i) {
    const double deviation = e.deviation[static_cast<Eigen::Index>(i)];
    fmt::print("{:<12}{:>9.4f}{:>10}{:>10.4f}\n", e.wanted[i].name, e.wanted[i].value,
               std::isfinite(deviation) ? fmt::format("{:.4f}", deviation) : "-",
               e.wanted[i].neutral);
  }
}

/// Opens each round with a new source. The source is opened with the models of the scene file: a
/// synthetic one renders those, whatever is tracked.
class Rounds {
 public:
  Rounds(const FitShapeOptions& options, PluginLoader& plugins)
      : options_(options), plugins_(plugins) {}

  OpenedScene open(const std::vector<std::string>& found) {
    base_ = open_source(options_.scene.scene, options_.scene.set, plugins_);
    if (!std::exchange(told_, true))
      for (const std::string& line : base_.plugin_notes->take_lines()) tell("{}\n", line);
    std::vector<std::string> overrides = options_.scene.set;
    overrides.insert(overrides.end(), found.begin(), found.end());
    total_ = base_.source->frame_count();
    return open_scene(options_.scene.scene, overrides, plugins_, std::move(base_.source),
                      base_.source_resolved);
  }
  std::optional<int> total() const {
    if (!options_.frames || (total_ && *total_ < *options_.frames)) return total_;
    return options_.frames;
  }

 private:
  const FitShapeOptions& options_;
  PluginLoader& plugins_;
  OpenedScene base_;
  std::optional<int> total_;
  bool told_ = false;  // the notes on the models, which are the same in every round
};

int finish(const ShapeEstimate& estimate, const FitShapeOptions& options) {
  for (const std::string& warning : warnings_of_bounds(estimate))
    tell("hypotrack: warning: {}\n", warning);
  write_whole(options.out, shape_file_text(estimate));
  fmt::print("shape in {}\n", options.out.string());
  return 0;
}

int fit_to_labels(const FitShapeOptions& options, const CommonOptions& common) {
  PluginLoader plugins(common.plugin_path);
  OpenedScene session = open_source(options.scene.scene, options.scene.set, plugins);
  for (const std::string& line : session.plugin_notes->take_lines()) tell("{}\n", line);
  const ShapeEstimateSettings settings = session.shape;
  const ShapeEstimate estimate =
      shape_of_labels(std::move(session), settings, options.frames.value_or(0));
  fmt::print(
      "{} of {} labelled frames, mean distance {:.1f} mm with the shape given, {:.1f} mm with "
      "the one found\n",
      estimate.used_frames, estimate.tracked_frames, 1e3 * estimate.first_distance,
      1e3 * estimate.distance);
  print_estimate(estimate);
  return finish(estimate, options);
}

int fit_shape(const FitShapeOptions& options, const CommonOptions& common) {
  expect_writable(options.out);
  if (options.from == "truth") return fit_to_labels(options, common);
  PluginLoader plugins(common.plugin_path);
  Rounds rounds(options, plugins);
  const InterruptGuard interrupt;
  std::unique_ptr<Progress> bar;
  const ShapeEstimateSettings settings =
      load_scene(options.scene.scene, options.scene.set).file.shape;
  ShapeProgress progress;
  progress.tracked = [&](const Frame& frame, const Solution& solution) {
    if (!bar) bar = std::make_unique<Progress>(rounds.total());
    if (!frame.problem.empty()) bar->say(fmt::format("frame {}: {}", frame.index, frame.problem));
    bar->advance(std::string(to_string(solution.status)));
  };
  progress.end_round = [&](int round, const ShapeEstimate& e) {
    bar.reset();
    fmt::print("round {} of {}: {} of {} tracked frames, cost {:.1f} to {:.1f}\n", round + 1,
               settings.rounds, e.used_frames, e.tracked_frames, e.first_cost, e.cost);
    print_estimate(e);
  };
  progress.stop = [&] { return interrupt.interrupted(); };
  const auto open = [&](const auto& overrides) { return rounds.open(overrides); };
  const ShapeEstimate estimate =
      estimate_shape(open, settings, options.frames.value_or(0), true, progress);
  if (interrupt.interrupted()) {
    tell("hypotrack: interrupted; nothing was written\n");
    return kInterruptedExitCode;
  }
  return finish(estimate, options);
}

}  // namespace

void add_fit_shape_command(const Command& root, CommonOptions& common, int& exit_code) {
  auto options = std::make_shared<FitShapeOptions>();
  const Command command = root.add_command(
      "fit-shape", "Fit the shapes of a scene's models and write them for their shape_file");
  add_scene_options(command, options->scene);
  command.add("--out", &options->out, "File for the shape",
              {.show_default = true, .check = file_name()});
  command.add("--frames", &options->frames, "Look at the first frames only",
              {.check = whole_number(1)});
  command.add("--from", &options->from,
              "images: track and fit in turn; truth: fit to the landmarks that the source knows",
              {.show_default = true, .check = one_of({"images", "truth"})});
  command.on_call([=, &common, &exit_code] { exit_code = fit_shape(*options, common); });
}

}  // namespace hypotrack::app
