#include "lab/report/trace/trace_plots.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "lab/report/trace/frame_curve.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

using test::message_of;
using testing::HasSubstr;

constexpr const char* kTraceHeader =
    "frame,search,dimension,evaluations,cost,truth_cost,cpu_seconds,wall_seconds\n";

class TracePlots : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& run, const std::string& rows) const {
    const auto folder = folder_.path() / run;
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "trace.csv", std::ios::binary) << kTraceHeader << rows;
    return folder;
  }
  /// Two optimizers on two frames with a truth of cost -1 (a target of 10 % is -0.9): `a` takes 10
  /// and 40 evaluations, `b` takes 20 and fails after 30.
  StudyData study() const {
    StudyData study;
    study.is_study = true;
    study.scenes = {{"box", "box"}};
    study.axes = {{.key = "optimizer", .label = "optimizer", .values = {"a", "b"}}};
    study.tolerances = {0.1};
    StudyRun run;
    run.scene = "box";
    run.settings = {{"optimizer", "a"}};
    run.directory = write("a",
                          "0,0,7,10,-0.95,-1,0.1,0.1\n"
                          "1,0,7,10,-0.5,-1,0.1,0.1\n1,0,7,40,-0.9,-1,0.4,0.2\n");
    study.runs.push_back(run);
    run.settings = {{"optimizer", "b"}};
    run.directory = write("b",
                          "0,0,7,10,-0.5,-1,0.1,0.1\n0,0,7,20,-1,-1,0.2,0.1\n"
                          "1,0,7,10,-0.5,-1,0.1,0.1\n1,0,7,30,-0.8,-1,0.3,0.2\n");
    study.runs.push_back(run);
    return study;
  }
  static nlohmann::ordered_json plot(const StudyData& study, const std::string& kind) {
    Runs runs;
    for (const StudyRun& run : study.runs) runs.push_back(&run);
    return traced_plot(study, {.kind = kind, .color = "optimizer"}, runs);
  }
  /// Returns the value of a solver at the last place that is at most x, in a plot's first panel.
  static double value(const nlohmann::ordered_json& plot, const std::string& solver, double x) {
    double found = std::nan("");
    for (const auto& row : plot["facets"][0]["rows"])
      if (row["color"] == solver && row["x"].get<double>() <= x * (1 + 1e-9)) found = row["mean"];
    return found;
  }

  const test::TemporaryDirectory folder_;
};

TEST_F(TracePlots, SearchesOfAFrameFollowEachOther) {
  const auto file = write("run",
                          "3,0,7,16,-0.5,-1,0.5,0.25\n3,0,7,32,-0.5,-1,1,0.5\n"
                          "3,1,7,8,-0.4,-0.8,0.25,0.125\n3,1,7,16,-0.72,-0.8,0.5,0.25\n"
                          "5,0,7,16,,-1,0.5,0.25\n") /
                    "trace.csv";
  const std::vector<FrameCurve> curves = read_curves(file, TraceCost::evaluations);
  ASSERT_EQ(curves.size(), 2U);
  EXPECT_EQ(curves[0].frame, 3);
  EXPECT_EQ(curves[0].dimension, 7);
  EXPECT_EQ(curves[0].spent, 48);
  ASSERT_EQ(curves[0].steps.size(), 2U);  // only where something fell
  EXPECT_EQ(curves[0].steps[1].spent, 48);
  EXPECT_NEAR(curves[0].steps[1].excess, 0.1, 1e-12);
  EXPECT_EQ(curves[0].at(15), nullptr);
  EXPECT_EQ(curves[0].at(47)->excess, 0.5);
  EXPECT_TRUE(curves[1].steps.empty());  // nothing feasible
  EXPECT_FALSE(curves[1].towards(1).reached);
  EXPECT_EQ(curves[1].towards(1).spent, 16);
  EXPECT_EQ(read_curves(file, TraceCost::cpu_seconds)[0].spent, 1.5);
  EXPECT_EQ(read_curves(file, TraceCost::wall_seconds)[0].spent, 0.75);
}

TEST_F(TracePlots, ATruthOfCostZeroIsATargetOnlyWithoutAnExcess) {
  const auto file = write("run", "0,0,7,16,0.1,0,0,0\n0,0,7,32,0,0,0,0\n") / "trace.csv";
  EXPECT_EQ(read_curves(file, TraceCost::evaluations)[0].towards(100).spent, 32);
}

TEST_F(TracePlots, TargetsAreReachedAfterWhatTheTracesSay) {
  const auto plot = TracePlots::plot(study(), "targets");
  EXPECT_EQ(plot["facets"][0]["label"], "within 10 % of the truth's cost");
  EXPECT_EQ(value(plot, "a", 10), 50);
  EXPECT_EQ(value(plot, "a", 40), 100);
  EXPECT_EQ(value(plot, "b", 10), 0);
  EXPECT_EQ(value(plot, "b", 40), 50);
}

TEST_F(TracePlots, ProfilesCompareTheSameFrames) {
  // Ratios of a: 1 and 1; of b: 2 and never.
  const auto performance = plot(study(), "performance_profile");
  EXPECT_EQ(value(performance, "a", 1), 100);
  EXPECT_EQ(value(performance, "b", 1), 0);
  EXPECT_EQ(value(performance, "b", 2), 50);
  // Simplex gradients of a: 10/8 and 40/8; of b: 20/8.
  const auto data = plot(study(), "data_profile");
  EXPECT_EQ(value(data, "a", 1.25), 50);
  EXPECT_EQ(value(data, "a", 5), 100);
  EXPECT_EQ(value(data, "b", 5), 50);
  EXPECT_EQ(data["facets"][0]["rows"].back()["x"], 5);
}

TEST_F(TracePlots, RunningTimesAreExpectedOnes) {
  const auto plot = TracePlots::plot(study(), "expected_running_time");
  EXPECT_EQ(value(plot, "a", 10), 25);  // (10 + 40) / 2
  EXPECT_EQ(value(plot, "b", 10), 50);  // (20 + 30) / 1
  StudyData strict = study();
  strict.tolerances = {0.0};
  const auto none = TracePlots::plot(strict, "expected_running_time");
  ASSERT_EQ(none["facets"][0]["rows"].size(), 1U);  // a never gets there
  EXPECT_EQ(none["facets"][0]["rows"][0]["color"], "b");
}

TEST_F(TracePlots, ConvergenceIsTheMedianAndTheQuartiles) {
  const auto plot = TracePlots::plot(study(), "convergence");
  EXPECT_NEAR(value(plot, "a", 10), 27.5, 1e-9);  // of 5 and 50 % above the truth
  EXPECT_NEAR(value(plot, "a", 40), 7.5, 1e-9);   // of 5 and 10 %
  const auto& first = plot["facets"][0]["rows"][0];
  EXPECT_NEAR(first["lo"].get<double>(), 16.25, 1e-9);
  EXPECT_NEAR(first["hi"].get<double>(), 38.75, 1e-9);
  EXPECT_EQ(first["n"], 2);
}

TEST_F(TracePlots, WithoutATruthOnlyTheCostConverges) {
  StudyData study = this->study();
  write("a", "0,0,7,10,-0.95,,0.1,0.1\n");
  const auto plot = TracePlots::plot(study, "convergence");
  EXPECT_EQ(plot["value"]["label"], "lowest cost so far");
  EXPECT_EQ(value(plot, "a", 10), -0.95);
  EXPECT_TRUE(TracePlots::plot(study, "targets")["facets"].empty());
}

TEST_F(TracePlots, NamesADamagedTrace) {
  const auto folder = write("run", "");
  std::ofstream(folder / "trace.csv", std::ios::binary) << "frame,search\n0,0\n";
  EXPECT_THAT(message_of<DataError>([&] { read_curves(folder / "trace.csv", TraceCost{}); }),
              HasSubstr("trace.csv: has no column 'dimension'; repeat the run that wrote it"));
}

}  // namespace
}  // namespace hypotrack
