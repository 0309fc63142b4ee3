#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "judges.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// Returns measures that rise from the first to the last.
Measures rising() {
  Measures out{.known = true};
  for (std::size_t i = 0; i < out.values.size(); ++i)
    out.values[i] = 0.1 + 0.05 * static_cast<double>(i);
  return out;
}

/// Returns such measures after some were learned.
Measures learned() {
  Measures out = rising();
  out.usual = {0.98, 0.95, 0.98, 1.2, 0.7, 0.1, 1.6, 0.9, 0.95,
               0.6,  0.9,  0.1,  1.0, 1.0, 0.9, 0.8, 0.3, 0.8};
  out.experienced = true;
  return out;
}

/// A file of weights that tests damage.
class WeightsFile : public testing::Test {
 protected:
  /// Writes the weights with each `piece` replaced by `by`, and returns the message of what reads
  /// them.
  std::string message_of_damage(const std::string& piece, const std::string& by) {
    const auto at = text_.find(piece);
    if (at == std::string::npos) ADD_FAILURE() << "no '" << piece << "' in the weights";
    return message_of(std::string(text_).replace(at, piece.size(), by));
  }
  std::string message_of(const std::string& text) {
    const auto file = folder_.path() / "weights.yaml";
    std::ofstream(file) << text;
    return test::message_of<ConfigError>(
        [&] { test::make_judge("network", "weights: " + file.string()); });
  }

  static std::string read() {
    std::ostringstream out;
    out << std::ifstream(data_file("judges/hands_and_boxes.yaml")).rdbuf();
    return out.str();
  }

  test::TemporaryDirectory folder_;
  const std::string text_ = read();
};

TEST(NetworkJudge, AnswersAsTheWeightsSay) {
  EXPECT_NEAR(test::make_judge("network")->log_odds(rising()), -11.112157342686798, 1e-9);
  EXPECT_NEAR(test::make_judge("network")->log_odds(learned()), -17.54665150338846, 1e-9);
}

TEST(NetworkJudge, IgnoresWhatIsUsualBeforeItIsKnown) {
  Measures fresh = learned();
  fresh.experienced = false;
  EXPECT_EQ(test::make_judge("network")->log_odds(fresh),
            test::make_judge("network")->log_odds(rising()));
}

TEST(NetworkJudge, CountsLikenessHalfForATrackedModel) {
  const auto judge = test::make_judge("network");
  Measures measures = learned();
  const double unknown = judge->log_odds(measures);
  measures.usual_likeness = 0.8;
  measures.likeness = 0.3;
  const double unlike = judge->log_odds(measures);
  EXPECT_NEAR(unlike, unknown - 9 * 0.8 * 0.5, 1e-9);
  measures.tracked = true;
  EXPECT_NEAR(judge->log_odds(measures), (unknown + unlike) / 2, 1e-9);
}

TEST(NetworkJudge, TakesItsThresholdsFromTheScene) {
  EXPECT_EQ(test::make_judge("network")->thresholds().tracked_above,
            JudgeThresholds().tracked_above);
  EXPECT_EQ(test::make_judge("network", "tracked_above: 0.7")->thresholds().tracked_above, 0.7);
}

TEST_F(WeightsFile, ThatIsTheOneInstalledGivesTheSameAnswers) {
  const auto file = folder_.path() / "weights.yaml";
  std::ofstream(file) << text_;
  EXPECT_EQ(test::make_judge("network", "weights: " + file.string())->log_odds(learned()),
            test::make_judge("network")->log_odds(learned()));
}

TEST_F(WeightsFile, MayLeaveMeasuresOutAndOrderThemAsItLikes) {
  const auto file = folder_.path() / "weights.yaml";
  const std::string network = "{bias: 1, units: [{bias: 0, out: 2, in: [1, 10, 0, 100]}]}";
  std::ofstream(file) << "version: 1\nfitted_to: []\ntrained_on: nothing\n"
                         "measures: [agreement, correlation]\nlikeness: 0\nfresh: "
                      << network << "\nexperienced: " << network << "\n";
  Measures measures = rising();
  const double plain = measures[Measures::kAgreement] + 10 * measures[Measures::kCorrelation];
  EXPECT_NEAR(test::make_judge("network", "weights: " + file.string())->log_odds(measures),
              1 + 2 * plain, 1e-12);
  measures.experienced = true;  // all that is usual is 0
  EXPECT_NEAR(test::make_judge("network", "weights: " + file.string())->log_odds(measures),
              1 + 2 * (plain + 100 * measures[Measures::kCorrelation]), 1e-12);
}

TEST_F(WeightsFile, OfAnotherVersionIsRefusedWithBoth) {
  EXPECT_THAT(message_of_damage("version: 1", "version: 2\nnew_key: 3"),
              AllOf(HasSubstr("weights.yaml:3:"), HasSubstr("found weights for version 2"),
                    HasSubstr("expected 1")));
}

TEST_F(WeightsFile, WithTooFewWeightsNamesTheUnit) {
  EXPECT_THAT(message_of_damage("in: [0.2576, ", "in: ["),
              AllOf(HasSubstr("weights.yaml:16:"), HasSubstr("fresh.units.0.in: has 35 weights"),
                    HasSubstr("expected 36: two for each of 18 measures")));
}

TEST_F(WeightsFile, WithANumberThatIsNotFiniteIsRefused) {
  EXPECT_THAT(message_of_damage("in: [0.2576, ", "in: [.inf, "),
              AllOf(HasSubstr("weights.yaml:16:"), HasSubstr("finite")));
}

TEST_F(WeightsFile, WithAMisspeltMeasureNamesTheNearest) {
  EXPECT_THAT(message_of_damage("[correlation", "[corelation"),
              AllOf(HasSubstr("measures.0: there is no measure 'corelation'"),
                    HasSubstr("did you mean 'correlation'?")));
  EXPECT_THAT(message_of_damage("texture,", "correlation,"), HasSubstr("stands there twice"));
}

TEST_F(WeightsFile, ThatIsBrokenIsRefusedWithThePlace) {
  EXPECT_THAT(message_of(text_.substr(0, text_.size() / 2)), HasSubstr("weights.yaml:"));
  EXPECT_THAT(message_of_damage("bias: -0.43109", "bias: much"),
              AllOf(HasSubstr("weights.yaml:14:"), HasSubstr("fresh.bias")));
  EXPECT_THAT(message_of_damage("bias: -0.43109", "bias: .nan"), HasSubstr("fresh.bias"));
  EXPECT_THAT(message_of(""), HasSubstr("version"));
}

TEST_F(WeightsFile, WithoutUnitsIsRefused) {
  const std::string network = "{bias: 1, units: []}";
  EXPECT_THAT(message_of("version: 1\nfitted_to: []\ntrained_on: nothing\nmeasures: [edges]\n"
                         "likeness: 0\nfresh: " +
                         network + "\nexperienced: " + network + "\n"),
              HasSubstr("has no units"));
}

/// Poses that are right where the surface agrees, before and after something was learned.
JudgeFit poses_by_agreement(int count) {
  JudgeFit out{.poses = {}, .right = 0.01, .wrong = 0.02, .models = {"lamp"}, .source = "made up"};
  for (int i = 0; i < count; ++i) {
    KnownPose pose;
    pose.measures = i % 2 == 0 ? rising() : learned();
    const double share = static_cast<double>(i % 101) / 100;
    pose.measures.values[Measures::kAgreement] = share;
    pose.measures.known = true;
    pose.error = share > 0.6 ? 0.005 : share > 0.5 ? 0.015 : 0.05;
    out.poses.push_back(pose);
  }
  return out;
}

TEST_F(WeightsFile, OfAFitGivesTheAnswersOfTheFittedJudge) {
  const FittedJudge fitted = test::make_judge("network")->fit(poses_by_agreement(2020));
  EXPECT_THAT(fitted.file, AllOf(HasSubstr("\nfitted_to: [lamp]\n"), HasSubstr("made up")));
  const auto file = folder_.path() / "weights.yaml";
  std::ofstream(file) << fitted.file;
  const auto read = test::make_judge("network", "weights: " + file.string());
  for (const double share : {0.1, 0.4, 0.7, 0.95})
    for (Measures measures : {rising(), learned()}) {
      measures.values[Measures::kAgreement] = share;
      EXPECT_EQ(read->log_odds(measures), fitted.judge->log_odds(measures));
      EXPECT_EQ(read->log_odds(measures) > 0, share > 0.55) << share;
    }
}

TEST(NetworkJudge, IsNotFittedToAHandfulOfPoses) {
  EXPECT_THAT(test::message_of<DataError>(
                  [] { test::make_judge("network")->fit(poses_by_agreement(300)); }),
              AllOf(HasSubstr("before the looks of a model were learned, expected 100 of each"),
                    HasSubstr("more frames or sequences")));
}

TEST(NetworkJudge, AFileThatIsNotThereIsNamed) {
  EXPECT_THAT(test::message_of<ConfigError>(
                  [] { test::make_judge("network", "weights: /no/such/file.yaml"); }),
              HasSubstr("/no/such/file.yaml"));
}

}  // namespace
}  // namespace hypotrack
