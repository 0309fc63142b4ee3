#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "app_test.hpp"

namespace hypotrack::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class EvaluateTest : public AppTest {
 protected:
  void SetUp() override { ASSERT_EQ(run(box_scene()).exit_code, 0); }
  std::string out() const { return path("out").string(); }
  nlohmann::json metrics_in(const std::string& file) const {
    return nlohmann::json::parse(read_text(path(file)));
  }
  /// Metrics without those that the tracker's own statuses give.
  nlohmann::json errors_in(const std::string& file) const {
    nlohmann::json errors = metrics_in(file);
    for (const char* key : {"tracked_frames", "uncertain_frames", "said_lost_frames",
                            "absent_frames", "tracked_share", "uncertain_share", "absent_share",
                            "false_tracked_share", "right_tracked_share", "returns"})
      errors.erase(key);
    return errors;
  }
};

TEST_F(EvaluateTest, ARunWithTruthGetsTheMetricsThatItGaveItself) {
  const std::string of_run = read_text(path("out/metrics.json"));
  std::filesystem::remove(path("out/metrics.json"));
  const Outcome outcome = run_program({"evaluate", out()});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(read_text(path("out/metrics.json")), of_run);
}

TEST_F(EvaluateTest, ARecordingIsATruth) {
  const std::string recording = path("recording").string();
  ASSERT_EQ(run_program({"synth", scene(box_scene()), "--out", recording}).exit_code, 0);
  const std::string metrics = path("judged.json").string();
  const Outcome outcome = run_program({"evaluate", out(), "--truth", recording, "--out", metrics});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(read_text(metrics), read_text(path("out/metrics.json")));
}

TEST_F(EvaluateTest, PrintsEveryNumberOfItsFile) {
  const Outcome outcome = run_program({"evaluate", out()});
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("joints.csv against "), HasSubstr("first loss: never"),
                                 HasSubstr("metrics in ")));
  const auto metrics = metrics_in("out/metrics.json");
  const auto expect_row = [&](const std::string& name, const nlohmann::json& value, double factor,
                              int digits) {
    const std::string text =
        value.is_null() ? "-" : fmt::format("{:.{}f}", factor * value.get<double>(), digits);
    EXPECT_THAT(outcome.out, HasSubstr(fmt::format("\n{:<28}{:>10}\n", name, text)));
  };
  for (const auto& [name, key] :
       {std::pair{"frames", "frames"}, std::pair{"  with an error", "evaluated_frames"},
        std::pair{"  missing", "missing_frames"}, std::pair{"  lost", "lost_frames"},
        std::pair{"said to be tracked", "tracked_frames"},
        std::pair{"  uncertain", "uncertain_frames"}, std::pair{"  lost", "said_lost_frames"},
        std::pair{"  absent", "absent_frames"}, std::pair{"returns", "returns"}})
    expect_row(name, metrics.at(key), 1, 0);
  for (const auto& [name, key] :
       {std::pair{"mean error (mm)", "mean_error_mm"},
        std::pair{"standard deviation", "sd_error_mm"}, std::pair{"median", "median_error_mm"},
        std::pair{"75 % below", "p75_error_mm"}, std::pair{"90 % below", "p90_error_mm"},
        std::pair{"95 % below", "p95_error_mm"}, std::pair{"largest", "max_error_mm"},
        std::pair{"jitter (mm)", "jitter_mm"},
        std::pair{"  frames until then", "frames_to_recovery"}})
    expect_row(name, metrics.at(key), 1, 2);
  for (const auto& [name, key] : {std::pair{"tracked but wrong (%)", "false_tracked_share"},
                                  std::pair{"right and tracked (%)", "right_tracked_share"},
                                  std::pair{"absent but tracked (%)", "absent_tracked_share"},
                                  std::pair{"  recovered in 2 frames (%)", "recovered_2_share"},
                                  std::pair{"  in 10 frames (%)", "recovered_10_share"}})
    expect_row(name, metrics.at(key), 100, 2);
  for (const int mm : {5, 10, 20, 30, 40, 50})
    expect_row(fmt::format("frames below {} mm (%)", mm),
               metrics.at(fmt::format("success_{}mm", mm)), 100, 2);
  expect_row("AUC 20-50 mm", metrics.at("auc_20_50"), 1, 3);
  for (const auto& [name, mean] : metrics.at("models").items()) expect_row(name, mean, 1, 2);
  for (const auto& [name, mean] : metrics.at("landmarks").items()) expect_row(name, mean, 1, 2);
}

TEST_F(EvaluateTest, ATableFromElsewhereGetsItsMetricsBesideIt) {
  std::filesystem::copy_file(path("out/joints.csv"), path("other.csv"));
  const Outcome outcome = run_program({"evaluate", path("other.csv").string(), "--truth", out()});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(errors_in("other.metrics.json"), errors_in("out/metrics.json"));
  EXPECT_TRUE(metrics_in("other.metrics.json").at("tracked_frames").is_null());
  EXPECT_EQ(metrics_in("out/metrics.json").at("tracked_frames"), 5);
  EXPECT_THAT(outcome.out, testing::Not(HasSubstr("said to be tracked")));
}

TEST_F(EvaluateTest, NamesAndUnitsOfAnotherTracker) {
  std::string table = read_text(path("out/joints.csv"));
  for (const char* axis : {"_x", "_y", "_z"})
    table = replaced(table, std::string("box.center") + axis, std::string("middle") + axis);
  write_text(path("other.csv"), table);
  const std::vector<std::string> judge = {"evaluate", path("other.csv").string(), "--truth", out()};
  const Outcome refused = run_program(judge);
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err,
              AllOf(HasSubstr("hypotrack: "), HasSubstr("'middle' is no landmark of")));
  EXPECT_EQ(refused.out, "");
  EXPECT_FALSE(std::filesystem::exists(path("other.metrics.json")));

  std::vector<std::string> renamed = judge;
  renamed.insert(renamed.end(), {"--rename", "middle=box.center"});
  EXPECT_EQ(run_program(renamed).exit_code, 0);
  EXPECT_EQ(errors_in("other.metrics.json"), errors_in("out/metrics.json"));

  renamed.insert(renamed.end(), {"--units", "mm"});
  const Outcome units = run_program(renamed);
  EXPECT_EQ(units.exit_code, 1);
  EXPECT_THAT(units.err, HasSubstr("--truth-units"));
}

TEST_F(EvaluateTest, ATableCutAtTheEndOfALineIsRefused) {
  for (const char* name : {"joints.csv", "track.csv", "truth_landmarks.csv"}) {
    const std::filesystem::path table = path("out") / name;
    const std::string text = read_text(table);
    write_text(table, text.substr(0, text.rfind('\n', text.size() - 2) + 1));
    const std::string file = path("judged.json").string();
    const Outcome outcome = run_program({"evaluate", out(), "--out", file});
    EXPECT_EQ(outcome.exit_code, 1) << outcome.out;
    EXPECT_THAT(outcome.err, HasSubstr(std::string(name) + ": has 4 rows, expected 5, "));
    EXPECT_FALSE(std::filesystem::exists(file));
    write_text(table, text);
  }
}

TEST_F(EvaluateTest, MetricsThatCannotBeWritten) {
  const Outcome outcome =
      run_program({"evaluate", out(), "--out", path("none/metrics.json").string()});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("none/metrics.json: cannot be written"));
}

}  // namespace
}  // namespace hypotrack::test
