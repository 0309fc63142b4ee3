#include "track/verify/pose_verifier.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "painted_box.hpp"

namespace hypotrack {
namespace {

class PoseVerifierTest : public testing::Test {
 protected:
  Evidence evidence_at(double x) {
    ModelVerifier verifier(box_.scene, 0, box_.cameras);
    return verifier.measure_evidence(box_.frame(), box_.state(x), {});
  }

  test::PaintedBox box_;
};

TEST_F(PoseVerifierTest, BothViewsAgreeWhereTheModelIs) {
  const Evidence right = evidence_at(0), wrong = evidence_at(0.06);
  ASSERT_TRUE(right.known);
  ASSERT_TRUE(wrong.known);
  for (const auto index : {Evidence::kCorrelation, Evidence::kTexture, Evidence::kAgreement,
                           Evidence::kWorstAgreement})
    EXPECT_GT(right[index], wrong[index] + 0.2) << evidence_names()[index];
  EXPECT_LT(right[Evidence::kDifference], wrong[Evidence::kDifference]);
  EXPECT_GT(right[Evidence::kAgreement], 0.9);
}

TEST_F(PoseVerifierTest, ALongThinModelIsMeasuredAsWell) {
  const test::PaintedBox stick(0.5, 0.02);
  ModelVerifier verifier(stick.scene, 0, stick.cameras);
  const Evidence right = verifier.measure_evidence(stick.frame(), stick.state(), {});
  ASSERT_TRUE(right.known);
  EXPECT_GT(right[Evidence::kAgreement], 0.8);
  EXPECT_GT(right[Evidence::kTexture], 0.5);
}

TEST_F(PoseVerifierTest, SurfacesBesideTheSilhouetteDoNotAgree) {
  const Evidence right = evidence_at(0);
  EXPECT_LT(right[Evidence::kRingTexture], 0.5 * right[Evidence::kTexture]);
}

TEST_F(PoseVerifierTest, LearnedColorsTellTheModelFromWhatIsBesideIt) {
  ModelVerifier verifier(box_.scene, 0, box_.cameras);
  const Evidence before = verifier.measure_evidence(box_.frame(), box_.state(), {});
  EXPECT_EQ(before[Evidence::kInside], 0.5);
  EXPECT_FALSE(verifier.experienced());
  verifier.learn(before);
  EXPECT_TRUE(verifier.experienced());
  const Evidence right = verifier.measure_evidence(box_.frame(), box_.state(), {});
  EXPECT_GT(right[Evidence::kInside], 0.7);
  EXPECT_LT(right[Evidence::kRing], 0.3);
  const Evidence wrong = verifier.measure_evidence(box_.frame(), box_.state(0.1), {});
  EXPECT_LT(wrong[Evidence::kInside], right[Evidence::kInside] - 0.3);
}

TEST_F(PoseVerifierTest, FeaturesHaveDifferencesToWhatIsUsualOnceItIsKnown) {
  constexpr Eigen::Index kCount = Evidence::kCount;
  ModelVerifier verifier(box_.scene, 0, box_.cameras);
  const Evidence evidence = verifier.measure_evidence(box_.frame(), box_.state(), {});
  EXPECT_EQ(verifier.features(evidence).tail(kCount).norm(), 0);
  verifier.learn(evidence);
  const Evidence off = verifier.measure_evidence(box_.frame(), box_.state(0.03), {});
  EXPECT_LT(verifier.features(off)[kCount + Evidence::kAgreement], -0.1);
}

TEST_F(PoseVerifierTest, AModelThatNoCameraSeesIsSurelyWrong) {
  ModelVerifier verifier(box_.scene, 0, box_.cameras);
  Eigen::VectorXd behind = box_.state();
  behind[2] = -1;
  const Evidence evidence = verifier.measure_evidence(box_.frame(), behind, {});
  EXPECT_FALSE(evidence.known);
  EXPECT_EQ(verifier.log_odds(evidence), -std::numeric_limits<double>::infinity());
}

TEST_F(PoseVerifierTest, KnowsNothingWithoutColorsInTwoViews) {
  PoseVerifier verifier(box_.scene, box_.cameras);
  Frame frame = box_.frame();
  EXPECT_FALSE(std::isnan(verifier.verify(frame, box_.state(), {}, {true})[0]));
  frame.views[1].color.release();
  EXPECT_TRUE(std::isnan(verifier.verify(frame, box_.state(), {}, {true})[0]));
}

TEST_F(PoseVerifierTest, FindsTheRightPlaceLikelierThanOthers) {
  PoseVerifier verifier(box_.scene, box_.cameras);
  const Frame frame = box_.frame();
  verifier.verify(frame, box_.state(), {}, {true});
  verifier.learn({true});
  const double right = verifier.verify(frame, box_.state(), {}, {true})[0];
  for (const double x : {-0.1, -0.05, 0.05, 0.1})
    EXPECT_LT(verifier.verify(frame, box_.state(x), {}, {true})[0], right) << x;
}

TEST_F(PoseVerifierTest, CountsLikenessHalfForATrackedModel) {
  ModelVerifier verifier(box_.scene, 0, box_.cameras);
  for (int k = 0; k < 3; ++k)
    verifier.learn(verifier.measure_evidence(box_.frame(), box_.state(), {}));
  Evidence evidence = verifier.measure_evidence(box_.frame(), box_.state(), {});
  ASSERT_GT(verifier.usual_likeness(), 0);
  evidence.likeness = verifier.usual_likeness();
  const double alike = verifier.log_odds(evidence);
  evidence.likeness = verifier.usual_likeness() - 0.5;
  const double unlike = verifier.log_odds(evidence);
  EXPECT_LT(unlike, alike);
  verifier.set_tracked(true);
  EXPECT_NEAR(verifier.log_odds(evidence), (alike + unlike) / 2, 1e-9);
}

TEST_F(PoseVerifierTest, RemembersWhichStateItVerifiedLast) {
  PoseVerifier verifier(box_.scene, box_.cameras);
  EXPECT_FALSE(verifier.verified(box_.state()));
  verifier.verify(box_.frame(), box_.state(), {}, {true});
  EXPECT_TRUE(verifier.verified(box_.state()));
  EXPECT_FALSE(verifier.verified(box_.state(0.01)));
}

}  // namespace
}  // namespace hypotrack
