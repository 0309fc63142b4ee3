#include "output/run/trace_output.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace hypotrack::internal {
namespace {

std::string known(double number) { return std::isfinite(number) ? fmt::format("{}", number) : ""; }

}  // namespace

void TraceOutput::add(int frame, const FrameTrace& trace) {
  if (!file_) {
    file_.emplace(run_->file("trace.csv"));
    file_->write("frame,search,dimension,evaluations,cost,truth_cost,cpu_seconds,wall_seconds\n");
  }
  costs_[frame] = {trace.cost, trace.truth_cost};
  std::string lines;
  for (std::size_t i = 0; i < trace.searches.size(); ++i) {
    const OptimizerTrace& search = trace.searches[i];
    const std::string truth = known(search.truth_cost);
    for (const TraceStep& step : search.steps)
      lines += fmt::format("{},{},{},{},{},{},{:.6f},{:.6f}\n", frame, i, search.dimension,
                           step.evaluations, known(step.cost), truth, step.cpu_seconds,
                           step.wall_seconds);
  }
  file_->write(lines);
}

FrameOutcome TraceOutput::judge(int frame, double error_mm) {
  const auto found = costs_.find(frame);
  if (found == costs_.end()) return FrameOutcome::unknown;
  const auto [cost, truth_cost] = found->second;
  costs_.erase(found);
  const FrameOutcome outcome = outcome_of(error_mm, cost, truth_cost);
  if (!costs_file_) {
    costs_file_.emplace(run_->file("truth_costs.csv"));
    costs_file_->write("frame,cost,truth_cost,mean_joint_error_mm,outcome\n");
  }
  const std::string error = std::isfinite(error_mm) ? fmt::format("{:.4f}", error_mm) : "";
  costs_file_->write(fmt::format("{},{},{},{},{}\n", frame, known(cost), known(truth_cost), error,
                                 to_string(outcome)));
  return outcome;
}

}  // namespace hypotrack::internal
