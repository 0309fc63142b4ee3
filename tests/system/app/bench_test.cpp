#include <algorithm>
#include <nlohmann/json.hpp>

#include "app_test.hpp"

namespace hypotrack::test {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

/// A test with a table of a box, tracked in two ways that differ in threads only.
class BenchTest : public AppTest {
 protected:
  BenchTest() { scene(box_scene(), "box.yaml"); }

  static std::string table() {
    return R"(title: A box
scenes:
  box: {file: box.yaml, label: One box}
grid:
  backend:
    cpu: {evaluate.backend: cpu}
    one: {evaluate.backend: cpu, evaluate.threads: 1}
)";
  }

  Outcome bench(const std::string& text, const std::vector<std::string>& more = {},
                const std::string& out = "rows.json") const {
    write_text(path("table.yaml"), text);
    std::vector<std::string> arguments{"bench", "--table", path("table.yaml").string(), "--out",
                                       path(out).string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    if (std::ranges::find(more, "--seconds") == more.end())  // slow builds measure all frames, too
      arguments.insert(arguments.end(), {"--seconds", "300"});
    return run_program(arguments);
  }

  Outcome bench_with_fixtures(const std::string& text) const {
    return bench(text, {"--plugin-path", (build_dir() / "tests/plugin_fixtures/app").string()});
  }

  json rows() const { return json::parse(read_text(path("rows.json"))).at("rows"); }

  /// All rows' values of a column.
  std::vector<json> column(const char* name) const {
    std::vector<json> values;
    for (const json& row : rows()) values.push_back(row.at(name));
    return values;
  }
};

TEST_F(BenchTest, EverySceneInEveryWayIsARow) {
  scene(box_scene(), "other.yaml");
  const Outcome outcome =
      bench(replaced(table(), "grid:", "  other: {file: other.yaml, set: {tile.size: 48}}\ngrid:"),
            {"--set", "judge=none"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(column("scene"), ElementsAre("One box", "One box", "other", "other"));
  EXPECT_THAT(column("backend"), ElementsAre("cpu", "one", "cpu", "one"));
  EXPECT_THAT(column("status"), testing::Each("measured"));
  // The scene has five frames, the first of which warms up; each has eight particles times four.
  EXPECT_THAT(column("warm_up"), testing::Each(1));
  EXPECT_THAT(column("frames"), testing::Each(4));
  EXPECT_THAT(column("evaluations"), testing::Each(32));
  for (const char* name : {"median_ms", "p5_ms", "p95_ms", "fps", "evaluations_per_second",
                           "speed_over_cpu", "speed_over_one"})
    EXPECT_THAT(column(name), testing::Each(testing::Gt(0))) << name;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("median ms"), HasSubstr("x one"), HasSubstr("One box"),
                                 HasSubstr("one: cpu ("), HasSubstr("1 thread)")));
}

TEST_F(BenchTest, EqualSeedsGiveEqualErrorsInEveryWayAndRound) {
  ASSERT_EQ(bench(table(), {"--rounds", "2"}).exit_code, 0);
  EXPECT_THAT(column("round"), ElementsAre(1, 1, 2, 2));
  EXPECT_THAT(column("mean_error_mm"), testing::Each(rows()[0].at("mean_error_mm")));
  const json first = rows()[0].at("mean_error_mm");
  ASSERT_EQ(bench(table(), {"--set", "seed=2"}).exit_code, 0);
  EXPECT_NE(rows()[0].at("mean_error_mm"), first);
}

TEST_F(BenchTest, TracksTheSequenceAsARunDoes) {
  ASSERT_EQ(bench(table(), {"--warm-up", "0"}).exit_code, 0);
  ASSERT_EQ(run(box_scene()).exit_code, 0);
  const json metrics = json::parse(read_text(path("out/metrics.json")));
  EXPECT_THAT(column("frames"), testing::Each(5));
  EXPECT_NEAR(rows()[0].at("mean_error_mm"), metrics.at("mean_error_mm"), 1e-4);
}

TEST_F(BenchTest, AWayThatIsNotToBeHadIsARowWithTheReason) {
  const Outcome outcome =
      bench(replaced(table(), "    one:", "    none: {optimizer: {type: none}}\n    one:"));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(column("status"), ElementsAre("measured", "unavailable", "measured"));
  EXPECT_THAT(rows()[1].at("message"), HasSubstr("optimizer 'none'"));
  EXPECT_TRUE(rows()[1].at("fps").is_null());
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("- unavailable [1]"), HasSubstr("[1] ")));
}

TEST_F(BenchTest, AWayThatBreaksIsARowWithTheReason) {
  const Outcome outcome =
      bench_with_fixtures(replaced(table(), "    one:",
                                   "    bad: {optimizer: {type: failing, frames: 3}}\n"
                                   "    lost: {objective: {type: failing, frames: 3}}\n    one:"));
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("2 of 4 rows failed"));
  EXPECT_THAT(column("status"), ElementsAre("measured", "failed", "failed", "measured"));
  EXPECT_THAT(rows()[1].at("message").get<std::string>(),
              testing::EndsWith("threw std::runtime_error: the search is broken"));
  EXPECT_THAT(rows()[2].at("message").get<std::string>(),
              testing::EndsWith(": the device is lost"));
  EXPECT_THAT(column("frames"), ElementsAre(4, 0, 0, 4));
}

TEST_F(BenchTest, WhereNothingCanBeMeasuredTheReasonsAreThere) {
  const Outcome outcome = bench(table(), {"--set", "models.0.type=none"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("nothing could be measured"));
  EXPECT_THAT(outcome.out, HasSubstr("model 'none'"));
  EXPECT_THAT(column("status"), ElementsAre("unavailable", "unavailable"));
}

TEST_F(BenchTest, ScenesOfTheUserTakeThePlaceOfTheTables) {
  const Outcome outcome = bench(table(), {path("box.yaml").string(), "--backends", "one"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(column("scene"), ElementsAre(path("box.yaml").string()));
  EXPECT_THAT(column("backend"), ElementsAre("one"));
}

TEST_F(BenchTest, ARowThatTakesTooLongEndsWithTheFrame) {
  ASSERT_EQ(bench(table(), {"--seconds", "1e-9"}).exit_code, 0);
  EXPECT_THAT(column("frames"), testing::Each(1));
  EXPECT_THAT(column("warm_up"), testing::Each(0));
}

TEST_F(BenchTest, RelativePathsInChangesReferToTheTablesFolder) {
  ASSERT_EQ(run_program({"synth", path("box.yaml").string(), "--out", path("recording").string()})
                .exit_code,
            0);
  std::filesystem::copy(path("recording/calibration.yaml"), path("other_calibration.yaml"));
  ASSERT_EQ(
      bench(replaced(replaced(table(), "file: box.yaml", "file: recording/scene.yaml"),
                     "label: One box",
                     "label: One box, set: {source.calibration.file: other_calibration.yaml}"))
          .exit_code,
      0);
  EXPECT_THAT(column("status"), testing::Each("measured"));
}

TEST_F(BenchTest, MistakesAreOneMessage) {
  expect_refusal(bench(table(), {"--backends", "cpu,gpu"}), {"--backends gpu", "cpu, one"});
  expect_refusal(bench(table(), {"no_such.yaml"}), {"no_such.yaml", "no such scene file"});
  expect_refusal(bench(table(), {"--set", "tile.sise=2"}), {"tile.sise", "did you mean 'size'"});
  expect_refusal(bench(table(), {"--variant", "fast"}), {"has no variant 'fast'"});
  expect_refusal(bench(table(), {}, "rows.txt"), {"rows.txt", ".csv or .json"});
  expect_refusal(bench("title: none\nscenes: {box: {file: box.yaml}}\n"),
                 {"needs an axis 'backend'"});
  EXPECT_FALSE(std::filesystem::exists(path("rows.json")));
}

TEST_F(BenchTest, AFileThatCannotBeWrittenIsFoundBeforeAnythingIsMeasured) {
  expect_refusal(bench(table(), {}, "none/rows.csv"), {"none/rows.csv", "cannot be written"});
}

}  // namespace
}  // namespace hypotrack::test
