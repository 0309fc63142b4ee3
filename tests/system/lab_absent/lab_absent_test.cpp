#include "app_test.hpp"

namespace hypotrack::test {
namespace {

using testing::HasSubstr;

using LabAbsentTest = AppTest;

TEST_F(LabAbsentTest, CommandsOfTheLabSayWhatIsMissingAndWhatToInstall) {
  for (const std::string command : {"compare", "bench", "landscape", "reliability", "report"}) {
    const Outcome outcome = run_program({command, "study.yaml", "--out", path("out").string()});
    expect_refusal(outcome,
                   {"`hypotrack " + command + "` needs the lab, which is absent: ",
                    "apt-get install libboost-dev libjs-three libjs-vega libcpp-httplib-dev",
                    "build again with -DHYPOTRACK_LAB=ON"});
  }
}

TEST_F(LabAbsentTest, TheHelpSaysThatTheyAreNotInstalled) {
  const Outcome help = run_program({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_THAT(help.out, testing::ContainsRegex("compare .*\\(not installed\\)"));
}

TEST_F(LabAbsentTest, DoctorSaysWhatIsMissingAndWhatToInstall) {
  EXPECT_THAT(run_program({"doctor"}).out,
              testing::ContainsRegex("missing +lab commands .* are absent: [^\n]*\n"
                                     " +fix: sudo apt-get install libboost-dev"));
}

TEST_F(LabAbsentTest, ScenesAreValidatedAndTracked) {
  const std::string file = scene(box_scene());
  const Outcome validated = run_program({"validate", file});
  EXPECT_EQ(validated.exit_code, 0) << validated.err;
  const Outcome tracked = run_program({"run", file, "--out", path("out").string()});
  EXPECT_EQ(tracked.exit_code, 0) << tracked.err;
  EXPECT_EQ(lines_of(read_text(path("out/track.csv"))).size(), 6u);
}

TEST_F(LabAbsentTest, RecordingsAreWritten) {
  const Outcome outcome =
      run_program({"synth", scene(box_scene()), "--out", path("recording").string()});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(std::filesystem::exists(path("recording/left_000004.png")));
}

TEST_F(LabAbsentTest, PluginsAreListed) {
  const Outcome outcome = run_program({"plugins", "list"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, testing::AllOf(HasSubstr("rigid_box"), HasSubstr("stereo_color")));
}

}  // namespace
}  // namespace hypotrack::test
