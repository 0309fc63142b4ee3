#include "track/verify/pose_verifier.hpp"

#include <gtest/gtest.h>
#include <oneapi/tbb/task_arena.h>

#include <cmath>
#include <limits>
#include <memory>

#include "judges.hpp"
#include "painted_box.hpp"

namespace hypotrack {
namespace {

class PoseVerifierTest : public testing::Test {
 protected:
  Measures measures_at(double x) {
    ModelVerifier verifier(box_.scene, 0, box_.cameras);
    return verifier.measured(box_.frame(), box_.state(x), {});
  }

  test::PaintedBox box_;
  std::shared_ptr<const Judge> judge_ = std::make_shared<test::AgreementOnly>();
};

TEST_F(PoseVerifierTest, BothViewsAgreeWhereTheModelIs) {
  const Measures right = measures_at(0), wrong = measures_at(0.06);
  ASSERT_TRUE(right.known);
  ASSERT_TRUE(wrong.known);
  for (const auto index : {Measures::kCorrelation, Measures::kTexture, Measures::kAgreement,
                           Measures::kWorstAgreement})
    EXPECT_GT(right[index], wrong[index] + 0.2) << measure_infos()[index].name;
  EXPECT_LT(right[Measures::kDifference], wrong[Measures::kDifference]);
  EXPECT_GT(right[Measures::kAgreement], 0.9);
}

TEST_F(PoseVerifierTest, ALongThinModelIsMeasuredAsWell) {
  const test::PaintedBox stick(0.5, 0.02);
  ModelVerifier verifier(stick.scene, 0, stick.cameras);
  const Measures right = verifier.measured(stick.frame(), stick.state(), {});
  ASSERT_TRUE(right.known);
  EXPECT_GT(right[Measures::kAgreement], 0.8);
  EXPECT_GT(right[Measures::kTexture], 0.5);
}

TEST_F(PoseVerifierTest, SurfacesBesideTheSilhouetteDoNotAgree) {
  const Measures right = measures_at(0);
  EXPECT_LT(right[Measures::kRingTexture], 0.5 * right[Measures::kTexture]);
}

TEST_F(PoseVerifierTest, LearnedColorsTellTheModelFromWhatIsBesideIt) {
  ModelVerifier verifier(box_.scene, 0, box_.cameras);
  const Measures before = verifier.measured(box_.frame(), box_.state(), {});
  EXPECT_EQ(before[Measures::kInside], 0.5);
  EXPECT_FALSE(verifier.experienced());
  verifier.learn(before);
  EXPECT_TRUE(verifier.experienced());
  const Measures right = verifier.measured(box_.frame(), box_.state(), {});
  EXPECT_GT(right[Measures::kInside], 0.7);
  EXPECT_LT(right[Measures::kRing], 0.3);
  const Measures wrong = verifier.measured(box_.frame(), box_.state(0.1), {});
  EXPECT_LT(wrong[Measures::kInside], right[Measures::kInside] - 0.3);
}

TEST_F(PoseVerifierTest, MeasuresKnowWhatIsUsualOnceItWasLearned) {
  ModelVerifier verifier(box_.scene, 0, box_.cameras);
  const Measures before = verifier.measured(box_.frame(), box_.state(), {});
  EXPECT_FALSE(before.experienced);
  EXPECT_EQ(before.usual[Measures::kAgreement], 0);
  verifier.learn(before);
  const Measures off = verifier.measured(box_.frame(), box_.state(0.03), {});
  EXPECT_TRUE(off.experienced);
  EXPECT_GT(off.usual[Measures::kAgreement], off[Measures::kAgreement] + 0.1);
}

TEST_F(PoseVerifierTest, MeasuresSayWhetherTheModelWasTrackedAndWhichItIs) {
  ModelVerifier verifier(box_.scene, 0, box_.cameras);
  EXPECT_FALSE(verifier.measured(box_.frame(), box_.state(), {}).tracked);
  verifier.set_tracked(true);
  const Measures measures = verifier.measured(box_.frame(), box_.state(), {});
  EXPECT_TRUE(measures.tracked);
  EXPECT_EQ(measures.model, 0u);
}

TEST_F(PoseVerifierTest, AModelThatNoCameraSeesIsSurelyWrong) {
  PoseVerifier verifier(box_.scene, box_.cameras, judge_);
  Eigen::VectorXd behind = box_.state();
  behind[2] = -1;
  const Measures measures = verifier.model(0).measured(box_.frame(), behind, {});
  EXPECT_FALSE(measures.known);
  EXPECT_EQ(verifier.log_odds(measures), -std::numeric_limits<double>::infinity());
  EXPECT_EQ(verifier.verify(box_.frame(), behind, {}, {true})[0], 0);
}

TEST_F(PoseVerifierTest, TheProbabilityIsThatOfTheJudgesLogOdds) {
  PoseVerifier verifier(box_.scene, box_.cameras, judge_);
  const Measures measures = verifier.model(0).measured(box_.frame(), box_.state(), {});
  const double odds = std::exp(judge_->log_odds(measures));
  EXPECT_NEAR(verifier.verify(box_.frame(), box_.state(), {}, {true})[0], odds / (1 + odds), 1e-12);
}

TEST_F(PoseVerifierTest, KnowsNothingWithoutColorsInTwoViews) {
  PoseVerifier verifier(box_.scene, box_.cameras, judge_);
  Frame frame = box_.frame();
  EXPECT_FALSE(std::isnan(verifier.verify(frame, box_.state(), {}, {true})[0]));
  frame.views[1].color.release();
  EXPECT_TRUE(std::isnan(verifier.verify(frame, box_.state(), {}, {true})[0]));
}

TEST_F(PoseVerifierTest, FindsTheRightPlaceLikelierThanOthers) {
  PoseVerifier verifier(box_.scene, box_.cameras, judge_);
  const Frame frame = box_.frame();
  verifier.verify(frame, box_.state(), {}, {true});
  verifier.learn({true});
  const double right = verifier.verify(frame, box_.state(), {}, {true})[0];
  for (const double x : {-0.1, -0.05, 0.05, 0.1})
    EXPECT_LT(verifier.verify(frame, box_.state(x), {}, {true})[0], right) << x;
}

TEST_F(PoseVerifierTest, LearnsTheSameWithAnyNumberOfThreads) {
  const auto learned_with = [&](int threads) {
    PoseVerifier verifier(box_.scene, box_.cameras, judge_);
    Measures out;
    tbb::task_arena(threads).execute([&] {
      for (const double x : {0.0, 0.001, -0.001, 0.002}) {
        verifier.verify(box_.frame(), box_.state(x), {}, {true});
        verifier.learn({true});
      }
      out = verifier.model(0).measured(box_.frame(), box_.state(), {});
    });
    return out;
  };
  const Measures one = learned_with(1), several = learned_with(3);
  EXPECT_EQ(one.values, several.values);
  EXPECT_EQ(one.usual, several.usual);
  EXPECT_EQ(one.likeness, several.likeness);
  EXPECT_GT(one[Measures::kInside], 0.7);
}

TEST_F(PoseVerifierTest, RemembersWhichStateItVerifiedLast) {
  PoseVerifier verifier(box_.scene, box_.cameras, judge_);
  EXPECT_FALSE(verifier.verified(box_.state()));
  verifier.verify(box_.frame(), box_.state(), {}, {true});
  EXPECT_TRUE(verifier.verified(box_.state()));
  EXPECT_FALSE(verifier.verified(box_.state(0.01)));
}

}  // namespace
}  // namespace hypotrack
