#include <fmt/format.h>
#include <fmt/ranges.h>

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/text_file.hpp"
#include "commands.hpp"
#include "hypotrack/api/error.hpp"
#include "interrupt.hpp"
#include "lab/judge/pose_sequences.hpp"
#include "messages.hpp"
#include "plugin/plugin_call.hpp"
#include "progress.hpp"

namespace hypotrack::app {
namespace {

struct FitJudgeOptions {
  std::vector<std::filesystem::path> scenes;
  std::vector<std::string> set;
  std::string judge = "network";
  int sequences = 16, frames = 120;
  double right_mm = 10, wrong_mm = 20;
  std::filesystem::path out = "judge.yaml";
  std::optional<std::filesystem::path> table;
};

constexpr int kHeldOut = 4;  // one sequence of so many tests the fit

/// Throws PluginError at once if a judge has nothing to fit. Others miss the poses.
void expect_fits(const Judge& judge) {
  try {
    judge.fit({});
  } catch (const DataError&) {
  }
}

/// Collects the poses of all sequences; nothing if the user interrupts it.
std::optional<std::vector<KnownPose>> collect(const FitJudgeOptions& options,
                                              PluginLoader& plugins) {
  const InterruptGuard interrupt;
  std::vector<KnownPose> out;
  Progress bar(options.sequences * options.frames);
  for (const PoseSequence& sequence :
       plan_pose_sequences(options.scenes, options.set, options.sequences, options.frames)) {
    const auto note = fmt::format("sequence {}", sequence.number + 1);
    const std::vector<KnownPose> found = collect_known_poses(sequence, plugins, [&](int) {
      bar.advance(note);
      return !interrupt.interrupted();
    });
    if (interrupt.interrupted()) return std::nullopt;
    out.insert(out.end(), found.begin(), found.end());
  }
  return out;
}

/// Prints how many of some poses a judge would call tracked, by their errors.
void print_row(const std::string& name, const Judge& judge, const std::vector<KnownPose>& poses,
               double above, double most) {
  fmt::print("{:<22}", name);
  for (const bool experienced : {false, true}) {
    int count = 0, tracked = 0;
    for (const KnownPose& pose : poses) {
      if (pose.measures.experienced != experienced) continue;
      if (!(pose.error > above && pose.error <= most)) continue;
      ++count;
      tracked += probability_of(judge.log_odds(pose.measures)) >= judge.thresholds().tracked_above;
    }
    fmt::print("{:>8.1f} % of {:<8}", count > 0 ? 100.0 * tracked / count : 0.0, count);
  }
  fmt::print("\n");
}

void print_held_out(const Judge& judge, const JudgeFit& all, const std::vector<KnownPose>& held) {
  const auto mm = [](double metres) { return fmt::format("{:g} mm", 1000 * metres); };
  fmt::print("Poses of held-out sequences above tracked_above ({}):\n{:<22}{:<21}{}\n",
             judge.thresholds().tracked_above, "", "  looks unknown", "looks learned");
  print_row("right, up to " + mm(all.right), judge, held, -1, all.right);
  print_row("between", judge, held, all.right, all.wrong);
  print_row("wrong, over " + mm(all.wrong), judge, held, all.wrong,
            std::numeric_limits<double>::infinity());
}

/// Returns the poses as CSV: what is true of each, its measures and the usual ones.
std::string table_of(const std::vector<KnownPose>& poses) {
  std::string out = "sequence,model,error_mm,searched,experienced,likeness,usual_likeness,covered";
  for (const char* usual : {"", "usual_"})
    for (const MeasureInfo& measure : measure_infos())
      out += fmt::format(",{}{}", usual, measure.name);
  out += '\n';
  for (const KnownPose& pose : poses) {
    const Measures& m = pose.measures;
    out +=
        fmt::format("{},{},{:.3f},{:d},{:d},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g}\n", pose.sequence,
                    m.model, 1000 * pose.error, pose.searched, m.experienced, m.likeness,
                    m.usual_likeness, m.covered, fmt::join(m.values, ","), fmt::join(m.usual, ","));
  }
  return out;
}

int fit_judge(const FitJudgeOptions& options, const CommonOptions& common) {
  if (!(options.wrong_mm >= options.right_mm))
    throw ConfigError(fmt::format("--wrong-mm is {:g}, less than --right-mm, which is {:g}",
                                  options.wrong_mm, options.right_mm));
  expect_writable(options.out);
  if (options.table) expect_writable(*options.table, "--table");
  PluginLoader plugins(common.plugin_path);
  const ConfigNode node = ConfigNode::parse("{type: " + options.judge + "}", "--judge");
  const std::unique_ptr<Judge> judge = plugins.make<Judge>(node);
  detail::set_label(*judge, kPluginKind<Judge>, node);
  expect_fits(*judge);
  JudgeFit all;
  all.right = options.right_mm * kMillimetre;
  all.wrong = options.wrong_mm * kMillimetre;
  all.models = model_types(options.scenes, options.set);
  std::optional<std::vector<KnownPose>> poses = collect(options, plugins);
  if (!poses) {
    tell("hypotrack: interrupted; nothing was written\n");
    return kInterruptedExitCode;
  }
  std::vector<std::string> names;
  for (const std::filesystem::path& scene : options.scenes)
    names.push_back(scene.filename().string());
  all.source = fmt::format("{} sequences of {}: {} poses, right up to {:g} mm, wrong over {:g} mm",
                           options.sequences, fmt::join(names, ", "), poses->size(),
                           options.right_mm, options.wrong_mm);
  fmt::print("{}\n", all.source);
  if (options.table) write_whole(*options.table, table_of(*poses));
  JudgeFit most = all;
  std::vector<KnownPose> held;
  for (const KnownPose& pose : *poses)
    (pose.sequence % kHeldOut == kHeldOut - 1 ? held : most.poses).push_back(pose);
  if (!held.empty()) print_held_out(*judge->fit(most).judge, all, held);
  all.poses = std::move(*poses);
  write_whole(options.out, judge->fit(all).file);
  fmt::print("judge in {0}; name it in scenes: `judge: {{type: {1}, weights: {0}}}`\n",
             options.out.string(), options.judge);
  return 0;
}

}  // namespace

void add_fit_judge_command(const Command& root, CommonOptions& common, int& exit_code) {
  auto options = std::make_shared<FitJudgeOptions>();
  const Command command =
      root.add_command("fit-judge", "Fit a judge to the models of scenes with ground truth");
  command.add("scenes", &options->scenes, "Scenes, rendered ones for example", {.required = true});
  add_set_option(command, options->set);
  command.add("--judge", &options->judge, "Judge to fit", {.show_default = true});
  command.add("--sequences", &options->sequences, "Sequences, of the scenes in turn",
              {.show_default = true, .check = whole_number(1)});
  command.add("--frames", &options->frames, "Frames of each sequence at most",
              {.show_default = true, .check = whole_number(1)});
  command.add("--right-mm", &options->right_mm, "Largest mean landmark error of a right pose",
              {.show_default = true, .check = positive_number()});
  command.add("--wrong-mm", &options->wrong_mm, "Error above which a pose is wrong",
              {.show_default = true, .check = positive_number()});
  command.add("--out", &options->out, "File for the judge",
              {.show_default = true, .check = file_name()});
  command.add("--table", &options->table, "Also write the poses and their measures (CSV)",
              {.check = file_name()});
  command.on_call([=, &common, &exit_code] { exit_code = fit_judge(*options, common); });
}

}  // namespace hypotrack::app
