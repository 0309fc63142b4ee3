#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/machine.hpp"
#include "commands.hpp"
#include "interrupt.hpp"
#include "lab/bench/bench_plan.hpp"
#include "lab/bench/bench_table.hpp"
#include "lab/bench/frames.hpp"
#include "lab/bench/measure.hpp"
#include "messages.hpp"
#include "progress.hpp"

namespace hypotrack::app {
namespace {

/// Exit code if a configuration failed while it tracked.
constexpr int kFailedExitCode = 3;

struct BenchOptions {
  bench::Request request;
  bench::Limits limits;
  std::optional<int> frames;
  int rounds = 1;
  bool profiles = false;
  std::filesystem::path out;
};

/// Measures a plan row by row.
class Bench {
 public:
  Bench(const bench::Plan& plan, const BenchOptions& options, PluginLoader& plugins)
      : plan_(plan),
        options_(options),
        plugins_(plugins),
        frames_(plugins, options.limits.warm_up + options.limits.frames),
        progress_(static_cast<int>(plan.cases.size() * plan.configurations.size()) * options.rounds,
                  Progress::Unit::runs) {}

  /// Returns false if the user interrupted it.
  bool run() {
    write();  // finds an unwritable file before anything is measured
    for (int round = 1; round <= options_.rounds; ++round)
      for (std::size_t c = 0; c < plan_.cases.size(); ++c)
        for (std::size_t configuration = 0; configuration < plan_.configurations.size();
             ++configuration) {
          bench::Measurement measurement =
              measure(plan_.cases[c], plan_.configurations[configuration]);
          if (interrupt_.interrupted()) return false;
          add({round, c, configuration, std::move(measurement)});
        }
    return true;
  }

  const std::vector<bench::Row>& rows() const { return rows_; }

 private:
  bench::Measurement measure(const bench::Case& c, const bench::Configuration& configuration) {
    std::vector<Frame>* frames = nullptr;
    try {
      frames = &frames_.of(c);
    } catch (const std::exception& e) {
      return {.outcome = bench::Outcome::unavailable, .message = e.what()};
    }
    return bench::measure(c, configuration, *frames, plugins_, options_.limits, options_.profiles,
                          [&] { return !interrupt_.interrupted(); });
  }

  /// Adds a row and rewrites the file, so that an abort keeps the rows before it.
  void add(bench::Row row) {
    rows_.push_back(std::move(row));
    const bench::Row& last = rows_.back();
    write();
    progress_.say(fmt::format("{}, {}: {}", plan_.cases[last.case_index].label,
                              plan_.configurations[last.configuration].name,
                              bench::in_words(last.measurement)));
    progress_.advance({});
  }

  void write() const {
    if (!options_.out.empty()) bench::write_rows(options_.out, plan_, rows_);
  }

  const bench::Plan& plan_;
  const BenchOptions& options_;
  PluginLoader& plugins_;
  bench::Frames frames_;
  InterruptGuard interrupt_;
  Progress progress_;
  std::vector<bench::Row> rows_;
};

void print_tables(const bench::Plan& plan, const BenchOptions& options,
                  const std::vector<bench::Row>& rows) {
  fmt::print("{}\n{}, {} core{}; up to {} frames after {}, about {} s a row\n", plan.title,
             processor_name(), core_count(), core_count() == 1 ? "" : "s", options.limits.frames,
             options.limits.warm_up, options.limits.seconds);
  for (int round = 1; round <= (rows.empty() ? 0 : rows.back().round); ++round) {
    if (options.rounds > 1) fmt::print("\nround {} of {}", round, options.rounds);
    fmt::print("\n{}", bench::table_text(plan, rows, round));
    fmt::print("{}", bench::profile_text(plan, rows, round));
  }
  if (!options.out.empty()) fmt::print("\nrows in {}\n", options.out.string());
}

int conclude(const std::vector<bench::Row>& rows) {
  const auto count = [&](bench::Outcome outcome) {
    return std::count_if(rows.begin(), rows.end(),
                         [&](const bench::Row& row) { return row.measurement.outcome == outcome; });
  };
  if (const auto failed = count(bench::Outcome::failed); failed > 0) {
    tell("hypotrack: {} of {} rows failed\n", failed, rows.size());
    return kFailedExitCode;
  }
  if (count(bench::Outcome::measured) > 0) return 0;
  tell("hypotrack: nothing could be measured; the reasons are below the table\n");
  return 1;
}

int run_bench(BenchOptions options, const CommonOptions& common) {
  if (!options.out.empty()) {
    bench::check_format(options.out);
    options.out = std::filesystem::absolute(options.out);
  }
  PluginLoader plugins(common.plugin_path);
  if (options.request.table.empty())
    options.request.table = data_file("configs/studies/bench.yaml");
  const bench::Plan plan = bench::make_plan(options.request);
  options.limits.frames = options.frames.value_or(plan.frames.value_or(options.limits.frames));
  bool complete = false;
  std::vector<bench::Row> rows;
  {
    Bench bench(plan, options, plugins);
    complete = bench.run();
    rows = bench.rows();
  }
  print_tables(plan, options, rows);
  if (complete) return conclude(rows);
  tell("hypotrack: interrupted; the tables end early\n");
  return kInterruptedExitCode;
}

void add_limits(const Command& command, BenchOptions& options) {
  command.add("--frames", &options.frames,
              "Frames to measure of each row (default: what the table says, or 50)",
              {.check = whole_number(1, 100'000)});
  command.add("--warm-up", &options.limits.warm_up, "Frames to track before those",
              {.show_default = true, .check = whole_number(0, 100'000)});
  command.add("--seconds", &options.limits.seconds,
              fmt::format("Time for a row; a slow one has fewer frames, at least {}, unless even "
                          "those take {} times as long",
                          bench::kFewestFrames, bench::kLongest),
              {.show_default = true, .check = positive_number()});
  command.add("--rounds", &options.rounds, "Measure everything so many times",
              {.show_default = true, .check = whole_number(1, 1000)});
}

}  // namespace

void add_bench_command(const Command& root, CommonOptions& common, int& exit_code) {
  auto options = std::make_shared<BenchOptions>();
  const Command command =
      root.add_command("bench", "Measure the speed of tracking, backend beside backend");
  command.add("scene", &options->request.scenes,
              "Scene files, or names of the table's scenes (default: all of those)",
              {.value_name = "PATH"});
  command.add("--table", &options->request.table,
              "Study file with scenes and, as the axis 'backend' of its grid, the ways to track "
              "them (default: configs/studies/bench.yaml of the installation)");
  command.add("--variant", &options->request.variant, "Variant of the table");
  command.add("--backends", &options->request.backends,
              "Cases of the axis 'backend' to measure, with commas between them (default: all)",
              {.commas = true});
  add_set_option(command, options->request.set);
  add_limits(command, *options);
  command.add("--profile", &options->profiles,
              "Print the time of each part of a frame; waiting for a GPU after each makes frames "
              "slower");
  command.add("--out", &options->out, "CSV or JSON file for the rows", {.check = file_name()});
  command.on_call([=, &common, &exit_code] { exit_code = run_bench(*options, common); });
}

}  // namespace hypotrack::app
