#include "app_test.hpp"

namespace hypotrack::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// Scenes that name a judge.
class JudgeTest : public AppTest {
 protected:
  std::string protocol() const { return read_text(path("out/run.yaml")); }
};

TEST_F(JudgeTest, ARunRecordsTheJudgeOfASceneThatNamesNone) {
  ASSERT_EQ(run(box_scene()).exit_code, 0);
  EXPECT_THAT(protocol(), HasSubstr("\njudge:\n  type: network\n"));
  EXPECT_THAT(protocol(), HasSubstr("\n  tracked_above: 0.55\n"));
}

TEST_F(JudgeTest, AWordNamesAJudgeWithItsDefaults) {
  ASSERT_EQ(run(box_scene() + "judge: agreement\n").exit_code, 0);
  EXPECT_THAT(protocol(), HasSubstr("\njudge:\n  type: agreement\n"));
}

TEST_F(JudgeTest, WithoutOneNoProbabilityIsKnown) {
  ASSERT_EQ(run(box_scene() + "judge: none\n").exit_code, 0);
  EXPECT_THAT(protocol(), HasSubstr("\njudge: none\n"));
  const auto rows = lines_of(read_text(path("out/track.csv")));
  ASSERT_THAT(rows, testing::SizeIs(6));
  for (std::size_t i = 1; i < rows.size(); ++i) EXPECT_THAT(rows[i], HasSubstr(",nan,"));
}

TEST_F(JudgeTest, AnUnknownOneIsRefusedWithThoseThatThereAre) {
  expect_refused(box_scene() + "judge: netwrok\n",
                 {"scene.yaml:13:8: judge.type: there is no judge 'netwrok'",
                  "did you mean 'network'?", "agreement, network"});
  expect_refused(box_scene() + "judge: {tracked_above: 0.5}\n", {"judge.type", "is missing"});
}

TEST_F(JudgeTest, ThresholdsOutOfOrderAreRefused) {
  expect_refused(box_scene() + "judge: {type: network, tracked_above: 0.2, uncertain_above: 0.9}\n",
                 {"scene.yaml:13:", "uncertain_above is 0.9, more than tracked_above"});
}

TEST_F(JudgeTest, TheFormerKeyForNoneWorksWithANote) {
  const Outcome former = run(box_scene() + "tracker: {evidence: false}\n");
  EXPECT_EQ(former.exit_code, 0);
  EXPECT_THAT(former.err, AllOf(HasSubstr("note: "), HasSubstr("scene.yaml:13:"),
                                HasSubstr("`tracker.evidence: false` is `judge: none` now; "),
                                HasSubstr("`hypotrack migrate FILE...` rewrites files")));
  EXPECT_THAT(protocol(), AllOf(HasSubstr("\njudge: none\n"), Not(HasSubstr("evidence"))));
}

TEST_F(JudgeTest, FormerKeysOfThresholdsGoToTheJudgeWithANote) {
  const Outcome former =
      run(box_scene(), {"--set", "tracker.tracked_above=0.7", "--set", "tracker.evidence=true"});
  EXPECT_EQ(former.exit_code, 0);
  EXPECT_THAT(former.err, HasSubstr("`tracker.tracked_above` is `judge.tracked_above`"));
  EXPECT_THAT(protocol(), HasSubstr("\n  tracked_above: 0.7\n"));
}

TEST_F(JudgeTest, FormerKeysAreCheckedAndNotTakenBesideAJudge) {
  expect_refused(box_scene(),
                 {"--set tracker.tracked_above=7: judge.tracked_above: ", "from 0 to 1"},
                 {"--set", "tracker.tracked_above=7"});
  expect_refused(
      box_scene() + "judge: agreement\ntracker: {evidence: false}\n",
      {"scene.yaml:14:", "found tracker.evidence beside `judge`, which has replaced it"});
}

}  // namespace
}  // namespace hypotrack::test
