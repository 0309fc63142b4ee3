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

TEST_F(EvaluateTest, PrintsATable) {
  const Outcome outcome = run_program({"evaluate", out()});
  const auto metrics = nlohmann::json::parse(read_text(path("out/metrics.json")));
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr("joints.csv against "), HasSubstr("first loss: never"),
                    HasSubstr("mean error (mm)"), HasSubstr("frames below 10 mm (%)"),
                    HasSubstr("AUC 20-50 mm"), HasSubstr("jitter (mm)"), HasSubstr("\nbox "),
                    HasSubstr("\nbox.center "), HasSubstr("metrics in ")));
  char mean[32];
  std::snprintf(mean, sizeof mean, "%.2f", metrics.at("mean_error_mm").get<double>());
  EXPECT_THAT(outcome.out, HasSubstr(mean));
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

TEST_F(EvaluateTest, MetricsThatCannotBeWritten) {
  const Outcome outcome =
      run_program({"evaluate", out(), "--out", path("none/metrics.json").string()});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("none/metrics.json: cannot be written"));
}

}  // namespace
}  // namespace hypotrack::test
