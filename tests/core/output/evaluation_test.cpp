#include "output/evaluate/evaluation.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <string>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

using test::message_of;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

/// Tables of two landmarks: a tip that is found 10 mm too far to the right, and a wrist.
const std::string kTruth =
    "frame,time,hand.wrist_x,hand.wrist_y,hand.wrist_z,hand.tip_x,hand.tip_y,hand.tip_z\n"
    "0,0,0,0,0.5,0.1,0,0.5\n"
    "1,0.1,0,0,0.5,0.1,0,0.5\n"
    "2,0.2,0,0,0.5,0.1,0,0.5\n";
const std::string kRun =
    "frame,time,hand.wrist_x,hand.wrist_y,hand.wrist_z,hand.tip_x,hand.tip_y,hand.tip_z\n"
    "0,0,0,0,0.5,0.11,0,0.5\n"
    "1,0.1,0,0,0.5,0.11,0,0.5\n"
    "2,0.2,0,0,0.5,0.11,0,0.5\n";

class EvaluationTest : public testing::Test {
 protected:
  std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }
  void write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories(path(name).parent_path());
    std::ofstream(path(name)) << text;
  }
  EvaluationInput tables(const std::string& run, const std::string& truth = kTruth) const {
    write("run.csv", run);
    write("truth.csv", truth);
    EvaluationInput input;
    input.run = path("run.csv");
    input.truth = path("truth.csv");
    return input;
  }
  std::string refusal(const EvaluationInput& input) const {
    return message_of<DataError>([&] { evaluate(input); });
  }

 private:
  test::TemporaryDirectory folder_;
};

std::string replaced(std::string text, const std::string& piece, const std::string& by) {
  for (auto at = text.find(piece); at != std::string::npos; at = text.find(piece, at + by.size()))
    text.replace(at, piece.size(), by);
  return text;
}

TEST_F(EvaluationTest, TwoTablesAreMatchedByFrame) {
  const Metrics m = evaluate(tables(kRun)).metrics;
  EXPECT_EQ(m.evaluated_frames, 3);
  EXPECT_NEAR(m.mean_error_mm, 5, 1e-9);
  EXPECT_THAT(m.models, ElementsAre(Pair("hand", testing::DoubleNear(5, 1e-9))));
  EXPECT_NEAR(m.jitter_mm, 0, 1e-9);
}

TEST_F(EvaluationTest, ARunFolderIsJudgedByItsOwnTruthAndItsStatuses) {
  write("run/joints.csv", kRun);
  write("run/truth_landmarks.csv", kTruth);
  write("run/track.csv", "frame,time,status\n0,0,missing\n1,0.1,tracked\n2,0.2,lost\n");
  EvaluationInput input;
  input.run = path("run");
  const Metrics m = evaluate(input).metrics;
  EXPECT_EQ(m.frames, 3);
  EXPECT_EQ(m.missing_frames, 1);
  EXPECT_EQ(m.evaluated_frames, 2);
  EXPECT_EQ(m.lost_frames, 1);
  EXPECT_EQ(m.frames_to_loss, 2);
  EXPECT_NEAR(m.time_to_loss_s, 0.2, 1e-12);
}

TEST_F(EvaluationTest, ATableOfARunHasARowForEachFrameOfItsSummary) {
  const std::string track = "frame,time,status\n0,0,tracked\n1,0.1,tracked\n2,0.2,tracked\n";
  const std::string errors = replaced(track, "time,status", "time,mean_joint_error_mm");
  const auto without_last = [](const std::string& table) {
    return table.substr(0, table.rfind('\n', table.size() - 2) + 1);
  };
  const auto write_all = [&](const std::string& name = "", int frames = 3) {
    write("run/summary.json", "{\"complete\": false, \"frames\": " + std::to_string(frames) + "}");
    for (const auto& [table, text] :
         {std::pair{"joints.csv", kRun}, std::pair{"truth_landmarks.csv", kTruth},
          std::pair{"track.csv", track}, std::pair{"errors.csv", errors}})
      write("run/" + std::string(table), table == name || frames < 3 ? without_last(text) : text);
  };
  EvaluationInput input;
  input.run = path("run");
  write_all();
  EXPECT_EQ(evaluate(input).metrics.frames, 3);
  write_all("", 2);  // of a run that was stopped
  EXPECT_EQ(evaluate(input).metrics.frames, 2);
  for (const char* table : {"joints.csv", "track.csv"}) {
    write_all(table);
    EXPECT_EQ(refusal(input), path("run/" + std::string(table)).string() +
                                  ": has 2 rows, expected 3, one for each frame of " +
                                  path("run/summary.json").string() +
                                  "; make the run again, or copy the whole table");
  }
  write_all("truth_landmarks.csv");
  EXPECT_THAT(refusal(input), AllOf(HasSubstr("truth_landmarks.csv: has 2 rows, expected 3, as "),
                                    HasSubstr("errors.csv; make the run again")));
  write_all();
  write("run/summary.json", "{\"frames\": 3");
  EXPECT_THAT(refusal(input), HasSubstr("summary.json: is no JSON object, expected the summary"));
}

TEST_F(EvaluationTest, StatusesAreJudgedByAbsenceAndByError) {
  write("run/joints.csv", kRun);
  write("run/truth_landmarks.csv", replaced(kTruth, "1,0.1,0,0,0.5,0.1,0,0.5",
                                            "1,0.1,absent,absent,absent,absent,absent,absent"));
  write("run/track.csv", "frame,time,status\n0,0,lost\n1,0.1,tracked\n2,0.2,tracked\n");
  write("run/uncertainty.csv", "frame,time,hand.wrist,hand.tip\n0,0,20,30\n2,0.2,1,1\n");
  EvaluationInput input;
  input.run = path("run");
  const Metrics m = evaluate(input).metrics;
  EXPECT_EQ(m.evaluated_frames, 2);
  EXPECT_EQ(m.status.tracked_frames, 2);
  EXPECT_DOUBLE_EQ(m.status.false_tracked_share, 0.5);
  EXPECT_DOUBLE_EQ(m.status.right_tracked_share, 0.5);
  EXPECT_EQ(m.status.returns, 1);
  EXPECT_DOUBLE_EQ(m.status.recovered_2_share, 1);
  EXPECT_NEAR(m.status.lost_sigma_min_mm, 25, 1e-9);
  write("run/track.csv", "frame,time,status\n0,0,found\n");
  EXPECT_THAT(refusal(input), HasSubstr("track.csv:2: the status is 'found'; expected tracked, "
                                        "uncertain, lost, absent or missing"));
}

TEST_F(EvaluationTest, OutcomesOfATracedRunAreKept) {
  write("run/joints.csv", kRun);
  write("run/truth_landmarks.csv", kTruth);
  write("run/truth_costs.csv",
        "frame,cost,truth_cost,mean_joint_error_mm,outcome\n0,-1,-2,5,found\n"
        "1,-1,-2,50,search_failed\n2,-1,,5,\n");
  EvaluationInput input;
  input.run = path("run");
  const auto shares = evaluate(input).metrics.outcomes;
  EXPECT_EQ(shares.share(FrameOutcome::found), 0.5);
  EXPECT_EQ(shares.share(FrameOutcome::search_failed), 0.5);
  input.truth = path("run/truth_landmarks.csv");  // may be of other poses than the costs
  EXPECT_TRUE(std::isnan(evaluate(input).metrics.outcomes.share(FrameOutcome::found)));
  input.truth.reset();
  write("run/truth_costs.csv", "frame,outcome\n0,lucky\n");
  EXPECT_THAT(refusal(input),
              HasSubstr("truth_costs.csv:2: the outcome is 'lucky'; expected found, "
                        "search_failed, objective_failed or nothing"));
}

TEST_F(EvaluationTest, FramesThatOneSideLacksAreCountedAndLeftOut) {
  const std::string run =
      replaced(replaced(kRun, "1,0.1,0,0,0.5,0.11,0,0.5\n", ""), "2,0.2,", "3,0.3,");
  const Metrics m = evaluate(tables(run, kTruth + "4,0.4,0,0,0.5,0.1,0,0.5\n")).metrics;
  EXPECT_EQ(m.frames, 4);          // 0 to 3, the frames of the run
  EXPECT_EQ(m.missing_frames, 2);  // 1 and 2
  EXPECT_EQ(m.evaluated_frames, 1);
}

TEST_F(EvaluationTest, ARowWithoutAnyNumberIsMissing) {
  const Metrics m =
      evaluate(tables(replaced(kRun, "1,0.1,0,0,0.5,0.11,0,0.5", "1,0.1,,,,nan,nan,nan"))).metrics;
  EXPECT_EQ(m.missing_frames, 1);
  EXPECT_EQ(m.evaluated_frames, 2);
}

TEST_F(EvaluationTest, TimesMayComeFromTheTruth) {
  std::string run = "frame,hand.wrist_x,hand.wrist_y,hand.wrist_z\n0,0,0,0.5\n1,0.1,0,0.5\n";
  EXPECT_NEAR(evaluate(tables(run)).metrics.time_to_loss_s, 0.1, 1e-12);
  const Metrics m = evaluate(tables(run, replaced(run, "1,0.1,", "1,0,"))).metrics;
  EXPECT_EQ(m.frames_to_loss, 1);
  EXPECT_TRUE(std::isnan(m.time_to_loss_s));
}

TEST_F(EvaluationTest, EitherSideMayLeaveOutTheModel) {
  EXPECT_NEAR(evaluate(tables(replaced(kRun, "hand.", ""))).metrics.mean_error_mm, 5, 1e-9);
  const Metrics m = evaluate(tables(kRun, replaced(kTruth, "hand.", ""))).metrics;
  EXPECT_NEAR(m.mean_error_mm, 5, 1e-9);
  EXPECT_EQ(m.models.front().first, "hand");
}

TEST_F(EvaluationTest, AnotherTrackersNamesAndUnitsCanBeSaid) {
  const std::string run =
      "frame,elbow_x,elbow_y,elbow_z,wrist_x,wrist_y,wrist_z,finger_x,finger_y,finger_z\n"
      "0,1,2,3,0,0,500,110,0,500\n"
      "1,1,2,3,0,0,500,110,0,500\n";
  EvaluationInput input = tables(run);
  input.rename = {"finger=hand.tip", "elbow="};
  input.run_metres_per_unit = 1e-3;
  EXPECT_NEAR(evaluate(input).metrics.mean_error_mm, 5, 1e-9);
}

TEST_F(EvaluationTest, ALandmarkThatTheTruthDoesNotHave) {
  EXPECT_THAT(
      refusal(tables(replaced(kRun, "hand.tip", "hand.tpi"))),
      AllOf(HasSubstr("run.csv: 'hand.tpi' is no landmark of " + path("truth.csv").string()),
            HasSubstr("'hand.tpi='"), HasSubstr("did you mean 'hand.tip'?")));
}

TEST_F(EvaluationTest, NoFrameInCommon) {
  std::string run =
      replaced(replaced(replaced(kRun, "\n0,", "\n10,"), "\n1,", "\n11,"), "\n2,", "\n12,");
  EXPECT_THAT(refusal(tables(run)), AllOf(HasSubstr("no frame in common"),
                                          HasSubstr("frames 10 to 12 against frames 0 to 2")));
}

TEST_F(EvaluationTest, NoLandmarkInCommon) {
  const std::string run = "frame,hand.wrist_x,hand.wrist_y,hand.wrist_z\n0,0,0,0.5\n";
  const std::string truth =
      "frame,hand.wrist_x,hand.wrist_y,hand.wrist_z,hand.tip_x,hand.tip_y,hand.tip_z\n"
      "0,,,,0,0,0.5\n";
  EXPECT_THAT(refusal(tables(run, truth)), HasSubstr("no landmark is known both here and in"));
}

TEST_F(EvaluationTest, OtherUnits) {
  const std::string run = replaced(replaced(kRun, "0.5", "500"), "0.11", "110");
  EXPECT_THAT(refusal(tables(run)),
              AllOf(HasSubstr("run.csv: its landmarks lie 5"), HasSubstr("metres unless --units")));
}

TEST_F(EvaluationTest, WhatIsNotThere) {
  EvaluationInput input = tables(kRun);
  input.truth.reset();
  EXPECT_THAT(refusal(input), HasSubstr("brings no truth of its own; name one with --truth"));
  input.truth = path("none");
  EXPECT_THAT(refusal(input), HasSubstr("none: is missing"));
  std::filesystem::create_directory(path("empty"));
  input.truth = path("empty");
  EXPECT_THAT(refusal(input), HasSubstr("empty: has no truth_landmarks.csv"));
  input.run = path("empty");
  EXPECT_THAT(refusal(input), HasSubstr("empty: has no joints.csv"));
  input.run = path("none");
  EXPECT_THAT(refusal(input), HasSubstr("none: is missing"));
}

TEST_F(EvaluationTest, ARunThatGoesOnIsNotEvaluated) {
  for (const auto& [name, text] :
       {std::pair("run.yaml", std::string("seed: 1")), std::pair("joints.csv", kRun),
        std::pair("truth_landmarks.csv", kTruth)})
    write(std::string("run/") + name, text);
  EvaluationInput input;
  input.run = path("run");
  EXPECT_THAT(refusal(input), AllOf(HasSubstr("run: the run has not ended, or was killed"),
                                    HasSubstr("no summary.json"), HasSubstr("run it again")));
  EvaluationInput other = tables(kRun);
  other.truth = path("run");
  EXPECT_THAT(refusal(other), HasSubstr("the run has not ended"));
  write("run/summary.json", "{}");
  EXPECT_NO_THROW(evaluate(input));
}

TEST_F(EvaluationTest, ATableOfOtherThings) {
  EXPECT_THAT(refusal(tables(kRun, "frame,cost\n0,1\n")),
              HasSubstr("truth.csv: has no landmark; expected"));
  EXPECT_THAT(refusal(tables(kRun, kTruth.substr(0, kTruth.find('\n') + 1))),
              HasSubstr("truth.csv: has no rows"));
  write("run/joints.csv", kRun);
  write("run/truth_landmarks.csv", kTruth);
  write("run/track.csv", "frame,status\n0,fine\n");
  EvaluationInput input;
  input.run = path("run");
  EXPECT_THAT(refusal(input), HasSubstr("track.csv:2: the status is 'fine'; expected tracked"));
}

}  // namespace
}  // namespace hypotrack
