#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>

#include "base/csv.hpp"
#include "run/run_scene.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

constexpr const char* kTracedScene = R"(models:
  - {name: box, type: rigid_box, size_mm: [60, 90, 40]}
source:
  type: synthetic
  frames: 4
  cameras: {width: 160, height: 120, focal_px: 150, baseline_mm: 100}
  keyframes:
    - {frame: 0, pose: {box: {position_mm: [0, 0, 400]}}}
    - {frame: 3, pose: {box: {position_mm: [10, 5, 410]}}}
objective: {type: stereo_color, direction: both}
recovery: {enabled: false}
search: {second_search: 0}
tile: {size: 64}
init: {from: truth}
output: {overlay: false, worst_frames: 0}
)";
constexpr const char* kSwarm = "optimizer={type: pso, particles: 16, generations: 8}";
constexpr const char* kLeastSquares = "optimizer={type: levenberg_marquardt}";

/// A row of trace.csv.
struct Row {
  int frame = 0, search = 0;
  double dimension = 0, evaluations = 0, cost = 0, truth_cost = 0, cpu = 0, wall = 0;
};

class TraceTest : public ::testing::Test {
 protected:
  void run(const std::string& out, std::vector<std::string> overrides) {
    const auto scene = folder_.path() / "scene.yaml";
    std::ofstream(scene) << kTracedScene;
    PluginLoader plugins;
    RunWatcher watcher;
    run_scene(scene, overrides, plugins, {.out = folder_.path() / out, .frames = {}}, watcher);
  }
  CsvTable table(const std::string& name) const { return CsvTable(folder_.path() / name); }
  /// Returns a column of a table.
  std::vector<double> column(const std::string& name, const std::string& of) const {
    const CsvTable rows = table(name);
    std::vector<double> out;
    for (const CsvTable::Row& row : rows.rows())
      out.push_back(rows.number(row, rows.find(of), true));
    return out;
  }
  std::vector<Row> rows(const std::string& out) const {
    const std::string file = out + "/trace.csv";
    const auto numbers = [&](const char* name) { return column(file, name); };
    const auto frame = numbers("frame"), search = numbers("search"),
               dimension = numbers("dimension"), evaluations = numbers("evaluations"),
               cost = numbers("cost"), truth = numbers("truth_cost"), cpu = numbers("cpu_seconds"),
               wall = numbers("wall_seconds");
    std::vector<Row> all;
    for (std::size_t i = 0; i < frame.size(); ++i)
      all.push_back({static_cast<int>(frame[i]), static_cast<int>(search[i]), dimension[i],
                     evaluations[i], cost[i], truth[i], cpu[i], wall[i]});
    return all;
  }
  /// Returns a table's text without the column of milliseconds.
  std::string untimed(const std::string& name) const {
    const CsvTable rows = table(name);
    std::string text;
    for (const CsvTable::Row& row : rows.rows())
      for (std::size_t i = 0; i < row.cells.size(); ++i)
        if (rows.columns()[i] != "milliseconds") text += std::string(row.cells[i]) + ",";
    return text;
  }

  const test::TemporaryDirectory folder_;
};

TEST_F(TraceTest, EveryGenerationIsAStepAndTheLastIsTheAnswer) {
  run("out", {kSwarm, "output.trace=true"});
  const std::vector<double> answers = column("out/track.csv", "cost");
  const std::vector<Row> all = rows("out");
  ASSERT_EQ(all.size(), 4 * 8U);
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(all[i].frame, static_cast<int>(i / 8));
    EXPECT_EQ(all[i].search, 0);
    EXPECT_EQ(all[i].dimension, 7);
    EXPECT_EQ(all[i].evaluations, 16.0 * static_cast<double>(i % 8 + 1));
    EXPECT_GE(all[i].cpu, 0);
    EXPECT_TRUE(std::isfinite(all[i].truth_cost));
    if (i % 8 == 0) continue;
    EXPECT_LE(all[i].cost, all[i - 1].cost);
    EXPECT_GE(all[i].wall, all[i - 1].wall);
  }
  for (std::size_t frame = 0; frame < 4; ++frame)
    EXPECT_EQ(all[8 * frame + 7].cost, answers[frame]);
}

TEST_F(TraceTest, ATracedRunFindsWhatAnotherFinds) {
  run("with", {kSwarm, "output.trace=true"});
  run("without", {kSwarm});
  EXPECT_EQ(untimed("with/track.csv"), untimed("without/track.csv"));
  EXPECT_GT(untimed("with/track.csv").size(), 100U);
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "without/trace.csv"));
}

TEST_F(TraceTest, ARunWithoutATraceRemovesAnEarlierOne) {
  run("out", {kSwarm, "output.trace=true"});
  run("out", {kSwarm});
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "out/trace.csv"));
}

TEST_F(TraceTest, AStartAtTheTruthCostsWhatTheTruthCosts) {
  run("out", {"optimizer={type: random_search}", "budget.evaluations=1", "output.trace=true"});
  const std::vector<Row> all = rows("out");
  ASSERT_FALSE(all.empty());
  EXPECT_EQ(all[0].evaluations, 1);
  EXPECT_NEAR(all[0].cost, all[0].truth_cost, 1e-9 * std::abs(all[0].truth_cost));
}

TEST_F(TraceTest, EveryFrameWithATruthIsJudged) {
  const auto outcomes = [&](const std::string& out) {
    const CsvTable rows = table(out + "/truth_costs.csv");
    std::string text;
    for (const CsvTable::Row& row : rows.rows())
      text += std::string(row.cells[static_cast<std::size_t>(rows.find("outcome"))]) + " ";
    return text;
  };
  run("found", {kSwarm, "output.trace=true"});
  EXPECT_EQ(outcomes("found"), "found found found found ");
  run("missed", {"optimizer={type: random_search}", "budget.evaluations=1",
                 "init={pose: {box: {position_mm: [40, 0, 400]}}}", "output.trace=true"});
  EXPECT_EQ(outcomes("missed"), "search_failed search_failed search_failed search_failed ");
  const std::vector<double> costs = column("missed/truth_costs.csv", "cost"),
                            truths = column("missed/truth_costs.csv", "truth_cost");
  for (std::size_t i = 0; i < costs.size(); ++i) EXPECT_GT(costs[i], truths[i]);
  std::ifstream file(folder_.path() / "missed/metrics.json");
  const std::string metrics{std::istreambuf_iterator<char>(file), {}};
  EXPECT_THAT(metrics, testing::HasSubstr("\"found_share\": 0.0"));
  EXPECT_THAT(metrics, testing::HasSubstr("\"search_failed_share\": 1.0"));
  EXPECT_THAT(metrics, testing::HasSubstr("\"objective_failed_share\": 0.0"));
}

TEST_F(TraceTest, JacobiansAreStepsThatCostEvaluations) {
  for (const std::string jacobian : {"analytic", "numerical"}) {
    run(jacobian, {kLeastSquares, "optimizer.jacobian=" + jacobian, "output.trace=true"});
    const std::vector<double> evaluations = column(jacobian + "/track.csv", "evaluations");
    const std::vector<Row> all = rows(jacobian);
    std::map<int, double> last;
    double largest = 0, before = 0;
    for (const Row& row : all) {
      if (row.frame == 0) largest = std::max(largest, row.evaluations - before);
      before = row.evaluations;
      last[row.frame] = row.evaluations;
    }
    for (const auto& [frame, count] : last)
      EXPECT_EQ(count, evaluations[static_cast<std::size_t>(frame)]) << jacobian;
    // A numerical Jacobian takes a point per dimension, an analytic one a single drawing.
    EXPECT_GE(largest, jacobian == "numerical" ? 6 : 1);
  }
}

}  // namespace
}  // namespace hypotrack
