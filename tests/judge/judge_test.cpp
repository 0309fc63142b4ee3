#include "track/judge/judge.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "painted_box.hpp"

namespace hypotrack {
namespace {

class JudgeTest : public testing::Test {
 protected:
  Evidence evidence_at(double x) {
    ModelJudge judge(box_.scene, 0, box_.cameras);
    return judge.look(box_.frame(), box_.state(x), {});
  }

  test::PaintedBox box_;
};

TEST_F(JudgeTest, BothViewsAgreeWhereTheModelIs) {
  const Evidence right = evidence_at(0), wrong = evidence_at(0.06);
  ASSERT_TRUE(right.known);
  ASSERT_TRUE(wrong.known);
  for (const auto index : {Evidence::kCorrelation, Evidence::kTexture, Evidence::kAgreement,
                           Evidence::kWorstAgreement})
    EXPECT_GT(right[index], wrong[index] + 0.2) << evidence_names()[index];
  EXPECT_LT(right[Evidence::kDifference], wrong[Evidence::kDifference]);
  EXPECT_GT(right[Evidence::kAgreement], 0.9);
}

TEST_F(JudgeTest, SurfacesBesideTheSilhouetteDoNotAgree) {
  const Evidence right = evidence_at(0);
  EXPECT_LT(right[Evidence::kRingTexture], 0.5 * right[Evidence::kTexture]);
}

TEST_F(JudgeTest, LearnedColorsTellTheModelFromWhatIsBesideIt) {
  ModelJudge judge(box_.scene, 0, box_.cameras);
  const Evidence before = judge.look(box_.frame(), box_.state(), {});
  EXPECT_EQ(before[Evidence::kInside], 0.5);
  EXPECT_FALSE(judge.experienced());
  judge.learn(before);
  EXPECT_TRUE(judge.experienced());
  const Evidence right = judge.look(box_.frame(), box_.state(), {});
  EXPECT_GT(right[Evidence::kInside], 0.7);
  EXPECT_LT(right[Evidence::kRing], 0.3);
  const Evidence wrong = judge.look(box_.frame(), box_.state(0.1), {});
  EXPECT_LT(wrong[Evidence::kInside], right[Evidence::kInside] - 0.3);
}

TEST_F(JudgeTest, FeaturesHaveDifferencesToWhatIsUsualOnceItIsKnown) {
  constexpr Eigen::Index kCount = Evidence::kCount;
  ModelJudge judge(box_.scene, 0, box_.cameras);
  const Evidence evidence = judge.look(box_.frame(), box_.state(), {});
  EXPECT_EQ(judge.features(evidence).tail(kCount).norm(), 0);
  judge.learn(evidence);
  const Evidence off = judge.look(box_.frame(), box_.state(0.03), {});
  EXPECT_LT(judge.features(off)[kCount + Evidence::kAgreement], -0.1);
}

TEST_F(JudgeTest, AModelThatNoCameraSeesIsSurelyWrong) {
  ModelJudge judge(box_.scene, 0, box_.cameras);
  Eigen::VectorXd behind = box_.state();
  behind[2] = -1;
  const Evidence evidence = judge.look(box_.frame(), behind, {});
  EXPECT_FALSE(evidence.known);
  EXPECT_EQ(judge.log_odds(evidence), -std::numeric_limits<double>::infinity());
}

TEST_F(JudgeTest, KnowsNothingWithoutColorsInTwoViews) {
  Judge judge(box_.scene, box_.cameras);
  Frame frame = box_.frame();
  EXPECT_FALSE(std::isnan(judge.judge(frame, box_.state(), {}, {true})[0]));
  frame.views[1].color.release();
  EXPECT_TRUE(std::isnan(judge.judge(frame, box_.state(), {}, {true})[0]));
}

TEST_F(JudgeTest, FindsTheRightPlaceLikelierThanOthers) {
  Judge judge(box_.scene, box_.cameras);
  const Frame frame = box_.frame();
  judge.judge(frame, box_.state(), {}, {true});
  judge.learn({true});
  const double right = judge.judge(frame, box_.state(), {}, {true})[0];
  for (const double x : {-0.1, -0.05, 0.05, 0.1})
    EXPECT_LT(judge.judge(frame, box_.state(x), {}, {true})[0], right) << x;
}

TEST_F(JudgeTest, CountsLikenessHalfForATrackedModel) {
  ModelJudge judge(box_.scene, 0, box_.cameras);
  for (int k = 0; k < 3; ++k) judge.learn(judge.look(box_.frame(), box_.state(), {}));
  Evidence evidence = judge.look(box_.frame(), box_.state(), {});
  ASSERT_GT(judge.usual_likeness(), 0);
  evidence.likeness = judge.usual_likeness();
  const double alike = judge.log_odds(evidence);
  evidence.likeness = judge.usual_likeness() - 0.5;
  const double unlike = judge.log_odds(evidence);
  EXPECT_LT(unlike, alike);
  judge.set_tracked(true);
  EXPECT_NEAR(judge.log_odds(evidence), (alike + unlike) / 2, 1e-9);
}

TEST_F(JudgeTest, RemembersWhichStateItJudgedLast) {
  Judge judge(box_.scene, box_.cameras);
  EXPECT_FALSE(judge.judged(box_.state()));
  judge.judge(box_.frame(), box_.state(), {}, {true});
  EXPECT_TRUE(judge.judged(box_.state()));
  EXPECT_FALSE(judge.judged(box_.state(0.01)));
}

}  // namespace
}  // namespace hypotrack
