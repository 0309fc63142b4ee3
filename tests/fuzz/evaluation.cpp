// The tables of a run that are compared with ground truth.

#include "output/evaluate/evaluation.hpp"

#include <array>

#include "output/evaluate/reliability_tables.hpp"
#include "parts.hpp"

namespace hypotrack::fuzz {
namespace {

constexpr std::array<std::string_view, 4> kEvaluatedFiles = {
    "joints.csv", "track.csv", "truth_landmarks.csv", "uncertainty.csv"};

}  // namespace

HYPOTRACK_FUZZ_TARGET(evaluation, "csv") {
  const std::filesystem::path run = scratch() / "evaluation";
  write_parts(bytes, run, kEvaluatedFiles);
  bool read = attempt([&] {
    EvaluationInput input;
    input.run = run;
    evaluate(input);
  });
  read |= attempt([&] {
    UncertaintyCalibration calibration;
    add_run(run, calibration);
  });
  if (!read) throw DataError("no run with ground truth");
}

}  // namespace hypotrack::fuzz
