#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/statistics.hpp"
#include "base/text_file.hpp"
#include "commands.hpp"
#include "hypotrack/api/error.hpp"
#include "lab/report/plots/reliability_plot.hpp"
#include "output/evaluate/reliability_tables.hpp"

namespace hypotrack::app {
namespace {

struct ReliabilityOptions {
  std::vector<std::filesystem::path> runs;
  std::filesystem::path out = "reliability.svg";
  std::string title = "How far off, and how far expected";
};

void print_bins(const Reliability& reliability) {
  fmt::print("{:>16} {:>9} {:>12} {:>12} {:>8}\n", "sigma (mm)", "landmarks", "rms sigma",
             "rms error", "ratio");
  for (const ReliabilityBin& bin : reliability.bins()) {
    if (bin.count == 0) continue;
    fmt::print("{:>16} {:>9} {:>12.2f} {:>12.2f} {:>8.2f}\n",
               fmt::format("{:g} to {:g}", 1000 * bin.low, 1000 * bin.high), bin.count,
               1000 * bin.sigma, 1000 * bin.error, bin.error / bin.sigma);
  }
  fmt::print("\nroot mean square of error / sigma: {:.2f}\n", reliability.error_over_sigma());
  for (const int sigmas : {1, 2, 3})
    fmt::print("within {} sigma: {:.1f} %\n", sigmas, 100 * reliability.within(sigmas));
}

void print_statuses(const UncertaintyCalibration& calibration) {
  fmt::print("\n{:>16} {:>9} {:>12} {:>12} {:>12}\n", "status", "frames", "median error",
             "95 % below", "largest");
  for (const char* status : {"tracked", "uncertain", "lost"}) {
    const auto found = calibration.errors_by_status.find(status);
    if (found == calibration.errors_by_status.end()) continue;
    const std::vector<double>& errors = found->second;
    fmt::print("{:>16} {:>9} {:>12.2f} {:>12.2f} {:>12.2f}\n", status, errors.size(),
               1000 * percentile(errors, 0.5), 1000 * percentile(errors, 0.95),
               1000 * percentile(errors, 1));
  }
}

int print_reliability(const ReliabilityOptions& options) {
  UncertaintyCalibration calibration;
  for (const std::filesystem::path& run : options.runs) add_run(run, calibration);
  if (calibration.reliability.count() == 0)
    throw DataError(fmt::format("{}: no landmark has both a sigma and a known error",
                                options.runs.front().string()));
  print_bins(calibration.reliability);
  print_statuses(calibration);
  write_whole(options.out, reliability_svg(calibration.reliability, options.title));
  fmt::print("\nplot in {}\n", options.out.string());
  return 0;
}

}  // namespace

void add_reliability_command(const Command& root, int& exit_code) {
  auto options = std::make_shared<ReliabilityOptions>();
  const Command command =
      root.add_command("reliability", "Compare predicted errors of landmarks with true ones");
  command.add("runs", &options->runs, "Folders of runs with uncertainty.enabled and a known truth",
              {.required = true});
  command.add("--out", &options->out, "Plot to write (SVG)",
              {.show_default = true, .check = file_name()});
  command.add("--title", &options->title, "Title of the plot");
  command.on_call([=, &exit_code] { exit_code = print_reliability(*options); });
}

}  // namespace hypotrack::app
