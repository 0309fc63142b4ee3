#include <fmt/format.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/text_file.hpp"
#include "commands.hpp"
#include "output/evaluate/evaluation.hpp"

namespace hypotrack::app {
namespace {

struct EvaluateOptions {
  EvaluationInput input;
  std::optional<std::filesystem::path> out;
  std::string units = "m";
  std::string truth_units = "m";
};

double metres_per(const std::string& unit) {
  if (unit == "mm") return 1e-3;
  return unit == "cm" ? 1e-2 : 1;
}

/// Formats a number with two decimals; `-` for NaN.
std::string shown(double value) { return std::isnan(value) ? "-" : fmt::format("{:.2f}", value); }

std::string loss_of(const Metrics& m) {
  if (!m.frames_to_loss) return "never";
  const std::string after = fmt::format("after {} frames", *m.frames_to_loss);
  return std::isnan(m.time_to_loss_s) ? after
                                      : fmt::format("{}, {:.2f} s", after, m.time_to_loss_s);
}

void print_means(const char* title, const std::vector<std::pair<std::string, double>>& means) {
  fmt::print("\n{:<28}{:>10}\n", title, "mean (mm)");
  for (const auto& [name, value] : means) fmt::print("{:<28}{:>10}\n", name, shown(value));
}

void print_row(const std::string& name, const std::string& value) {
  fmt::print("{:<28}{:>10}\n", name, value);
}

std::string percent(double share) { return shown(100 * share); }

void print_statuses(const StatusMetrics& s) {
  if (s.judged_frames == 0) return;
  print_row("said to be tracked", std::to_string(s.tracked_frames));
  print_row("  uncertain", std::to_string(s.uncertain_frames));
  print_row("  lost", std::to_string(s.said_lost_frames));
  print_row("  absent", std::to_string(s.absent_frames));
  print_row("tracked but wrong (%)", percent(s.false_tracked_share));
  print_row("right and tracked (%)", percent(s.right_tracked_share));
  print_row("absent but tracked (%)", percent(s.absent_tracked_share));
  print_row("returns", std::to_string(s.returns));
  print_row("  recovered in 2 frames (%)", percent(s.recovered_2_share));
  print_row("  in 10 frames (%)", percent(s.recovered_10_share));
  print_row("  frames until then", shown(s.frames_to_recovery));
}

void print_metrics(const Metrics& m) {
  print_row("frames", std::to_string(m.frames));
  print_row("  with an error", std::to_string(m.evaluated_frames));
  print_row("  missing", std::to_string(m.missing_frames));
  print_row("  lost", std::to_string(m.lost_frames));
  print_statuses(m.status);
  fmt::print("first loss: {}\n\n", loss_of(m));
  print_row("mean error (mm)", shown(m.mean_error_mm));
  print_row("standard deviation", shown(m.sd_error_mm));
  print_row("median", shown(m.median_error_mm));
  print_row("75 % below", shown(m.p75_error_mm));
  print_row("90 % below", shown(m.p90_error_mm));
  print_row("95 % below", shown(m.p95_error_mm));
  print_row("largest", shown(m.max_error_mm));
  print_row("jitter (mm)", shown(m.jitter_mm));
  for (std::size_t i = 0; i < m.success.size(); ++i)
    print_row(fmt::format("frames below {} mm (%)", kSuccessThresholdsMm[i]),
              shown(100 * m.success[i]));
  print_row("AUC 20-50 mm", fmt::format("{:.3f}", m.auc_20_50));
  print_means("model", m.models);
  print_means("landmark", m.landmarks);
}

/// Returns the output file: beside the evaluated run, unless the user names one.
std::filesystem::path metrics_file(const EvaluateOptions& options) {
  if (options.out) return *options.out;
  if (std::filesystem::is_directory(options.input.run)) return options.input.run / "metrics.json";
  std::filesystem::path file = options.input.run;
  return file.replace_extension(".metrics.json");
}

int evaluate_run(EvaluateOptions options) {
  options.input.run_metres_per_unit = metres_per(options.units);
  options.input.truth_metres_per_unit = metres_per(options.truth_units);
  const Evaluation evaluation = evaluate(options.input);
  const std::filesystem::path file = metrics_file(options);
  write_whole(file, to_json(evaluation.metrics));
  fmt::print("{} against {}\n\n", evaluation.run_table.string(), evaluation.truth_table.string());
  print_metrics(evaluation.metrics);
  fmt::print("\nmetrics in {}\n", file.string());
  return 0;
}

}  // namespace

void add_evaluate_command(const Command& root, int& exit_code) {
  auto options = std::make_shared<EvaluateOptions>();
  const OptionRules unit{.show_default = true, .check = one_of({"m", "cm", "mm"})};
  const Command command = root.add_command(
      "evaluate", "Judge a run, or the landmarks of another tracker, by ground truth");
  command.add("run", &options->input.run,
              "Folder of a run, or a CSV of landmarks: frame,time,<landmark>_x,_y,_z,...",
              {.required = true});
  command.add("--truth", &options->input.truth,
              "Recording, run or CSV of landmarks with the truth (default: the run's own)");
  command.add("--out", &options->out,
              "Where to write the metrics (default: metrics.json in the run's folder, "
              "NAME.metrics.json beside NAME.csv)",
              {.check = file_name()});
  command.add("--rename", &options->input.rename,
              "For the run: NAME=LANDMARK gives a name of its table to a landmark of the truth, "
              "NAME= drops it (may be repeated)",
              {.value_name = "NAME=LANDMARK"});
  command.add("--units", &options->units, "Unit of the run's table: m, cm or mm", unit);
  command.add("--truth-units", &options->truth_units, "Unit of the truth: m, cm or mm", unit);
  command.on_call([=, &exit_code] { exit_code = evaluate_run(*options); });
}

}  // namespace hypotrack::app
