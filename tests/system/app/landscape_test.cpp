#include "app_test.hpp"

namespace hypotrack::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class LandscapeCommandTest : public AppTest {
 protected:
  Outcome landscape(const std::string& text, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"landscape", scene(text),   "--out",  path("out").string(),
                                       "--points",  "5",           "--grid", "3",
                                       "--set",     "tile.size=32"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments);
  }
};

TEST_F(LandscapeCommandTest, SlicesTheCostAroundTheTruth) {
  const Outcome outcome = landscape(box_scene(), {"--frame", "2"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("frame 2: cost "), HasSubstr(" at the truth, the lowest "
                                                                        "of ")));
  EXPECT_EQ(lines_of(read_text(path("out/slices.csv"))).size(), 1 + 6 * 5u);
  EXPECT_EQ(lines_of(read_text(path("out/pairs.csv"))).size(), 1 + 15 * 9u);
  EXPECT_THAT(read_text(path("out/sum.svg")),
              AllOf(HasSubstr("Cost of frame 2 around the truth"), HasSubstr("</svg>")));
}

TEST_F(LandscapeCommandTest, SlicesAroundTheTrackedPoseWithoutATruth) {
  ASSERT_EQ(
      run_program({"synth", scene(box_scene()), "--out", path("recording").string()}).exit_code, 0);
  for (const char* truth : {"truth_states", "truth_landmarks"})
    std::filesystem::remove(path("recording") / (std::string(truth) + ".csv"));
  std::string tracked = read_text(path("recording/scene.yaml"));
  for (const char* key :
       {"  truth_states: truth_states.csv\n", "  truth_landmarks: truth_landmarks.csv\n"})
    if (tracked.find(key) != std::string::npos) tracked = replaced(tracked, key, "");
  write_text(path("recording/scene.yaml"), tracked);
  const Outcome outcome =
      run_program({"landscape", path("recording/scene.yaml").string(), "--out",
                   path("out").string(), "--frame", "1", "--points", "3", "--grid", "3", "--set",
                   "init={pose: {box: {position_mm: [0, 0, 400]}}}"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err << tracked;
  EXPECT_THAT(outcome.out, HasSubstr(" at the tracked pose, "));
}

TEST_F(LandscapeCommandTest, AFrameThatIsNotThereIsNamed) {
  expect_refusal(landscape(box_scene(), {"--frame", "99"}),
                 {"the source has no frame 99; its last one before is 4. Name another with"});
}

}  // namespace
}  // namespace hypotrack::test
