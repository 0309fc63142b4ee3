#include <nlohmann/json.hpp>

#include "app_test.hpp"

namespace hypotrack::test {
namespace {

using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::SizeIs;
using testing::StartsWith;

/// Runs of a box that say how far off they may be.
class ReliabilityTest : public AppTest {
 protected:
  static std::string scene_with_sigmas() { return box_scene() + "uncertainty: {enabled: true}\n"; }
  std::string out() const { return path("out").string(); }
  std::string plot() const { return path("plot.svg").string(); }
  Outcome judge() const { return run_program({"reliability", out(), "--out", plot()}); }
};

TEST_F(ReliabilityTest, ARunSaysHowFarOffLandmarksMayBe) {
  const Outcome outcome = run(scene_with_sigmas());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("sigma: mean "), HasSubstr("within one")));
  const auto lines = lines_of(read_text(path("out/uncertainty.csv")));
  ASSERT_THAT(lines, SizeIs(6));
  EXPECT_EQ(lines[0], "frame,time,box.center,box.end_x,box.end_y");
  EXPECT_THAT(lines[5], StartsWith("4,"));
  const auto summary = nlohmann::json::parse(read_text(path("out/summary.json")));
  EXPECT_GT(summary.at("mean_sigma_mm").get<double>(), 0);
  EXPECT_LE(summary.at("within_1_sigma").get<double>(), summary.at("within_3_sigma").get<double>());
}

TEST_F(ReliabilityTest, ARunThatIsNotToldToSaysNothing) {
  ASSERT_EQ(run(box_scene()).exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(path("out/uncertainty.csv")));
  EXPECT_FALSE(
      nlohmann::json::parse(read_text(path("out/summary.json"))).contains("mean_sigma_mm"));
}

TEST_F(ReliabilityTest, AgreesWithTheSummaryOfTheRun) {
  ASSERT_EQ(run(scene_with_sigmas()).exit_code, 0);
  const Outcome outcome = judge();
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto summary = nlohmann::json::parse(read_text(path("out/summary.json")));
  char share[64];
  std::snprintf(share, sizeof share, "within 2 sigma: %.1f %%",
                100 * summary.at("within_2_sigma").get<double>());
  EXPECT_THAT(outcome.out, HasSubstr(share));
  EXPECT_THAT(read_text(path("plot.svg")),
              AllOf(StartsWith("<svg "), HasSubstr("15 landmarks"), HasSubstr("</svg>")));
}

TEST_F(ReliabilityTest, ComparesSigmasWithErrorsInBins) {
  std::filesystem::create_directory(path("out"));
  write_text(path("out/uncertainty.csv"), "frame,time,box.a,box.b\n3,0,1.5,3\n4,0,1.5,nan\n");
  write_text(path("out/joints.csv"),
             "frame,time,box.a_x,box.a_y,box.a_z,box.b_x,box.b_y,box.b_z\n"
             "3,0,0,0.003,1,0,0,1\n4,0,0,0,1,0,0,1\n");
  write_text(path("out/truth_landmarks.csv"),
             "frame,time,box.b_x,box.b_y,box.b_z,box.a_x,box.a_y,box.a_z\n"
             "3,0,0,0,1.006,0,0,1\n4,0,0,0,2,0,0.001,1\n");
  write_text(path("out/track.csv"), "frame,status\n3,tracked\n4,uncertain\n");
  const Outcome outcome = judge();
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto lines = lines_of(outcome.out);
  EXPECT_THAT(lines[1], AllOf(HasSubstr("1 to 2"), HasSubstr(" 2 "), HasSubstr("1.50"),
                              HasSubstr("2.24"), HasSubstr("1.49")));
  EXPECT_THAT(lines[2], AllOf(HasSubstr("2 to 4"), HasSubstr(" 1 "), HasSubstr("6.00")));
  EXPECT_THAT(outcome.out, HasSubstr("within 1 sigma: 33.3 %"));
  EXPECT_THAT(outcome.out, ContainsRegex("tracked +1 +4.50 .*\n +uncertain +1 +500.50 "));
}

TEST_F(ReliabilityTest, ARunWithoutSigmasIsRefused) {
  ASSERT_EQ(run(box_scene()).exit_code, 0);
  const Outcome outcome = judge();
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("has no uncertainty.csv"), HasSubstr("uncertainty.enabled")));
  EXPECT_FALSE(std::filesystem::exists(plot()));
}

TEST_F(ReliabilityTest, AnObjectiveWithoutResidualsIsRefused) {
  expect_refused(replaced(scene_with_sigmas(), "{type: stereo_color}",
                          "{type: stereo_color, aggregation: mean_seen}"),
                 {"objective stereo_color", "offers no residuals", "uncertainty off"});
}

}  // namespace
}  // namespace hypotrack::test
