#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "judges.hpp"
#include "painted_box.hpp"
#include "track/occlude/occluder_finder.hpp"
#include "track/verify/pose_verifier.hpp"

namespace hypotrack {
namespace {

/// A painted box, the upper half of which a card before it hides.
class OccluderTest : public testing::Test {
 protected:
  static constexpr double kCard = 0.42;  // metres from the cameras

  OccluderTest() {
    verifier_.verify(box_.frame(), box_.state(), {}, {true});
    verifier_.learn({true});
  }

  Frame with_card(const cv::Scalar& color) const {
    Frame frame = box_.frame();
    for (std::size_t i = 0; i < 2; ++i) {
      const Camera& camera = box_.cameras[i];
      const auto at = [&](double x, double y) {
        x += camera.camera_from_world.translation().x();
        return cv::Point(cvRound(camera.fx * x / kCard + camera.cx),
                         cvRound(camera.fy * y / kCard + camera.cy));
      };
      cv::rectangle(frame.views[i].color, at(-0.09, -0.09), at(0.09, 0), color, cv::FILLED);
    }
    return frame;
  }
  HiddenViews find(const Frame& frame) {
    OccluderFinder finder(box_.scene, 0, box_.cameras);
    const auto parts = finder.find(frame, box_.state(), {}, verifier_.colors(0));
    HiddenViews out;
    if (parts) out.parts = {std::vector{(*parts)[0]}, std::vector{(*parts)[1]}};
    return out;
  }
  static Eigen::Matrix3Xd points_of(double y) {
    Eigen::Matrix3Xd out(3, 5);
    for (int i = 0; i < 5; ++i) out.col(i) << 0.02 * (i - 2), y, test::PaintedBox::kFace;
    return out;
  }

  test::PaintedBox box_;
  PoseVerifier verifier_{box_.scene, box_.cameras, std::make_shared<test::AgreementOnly>()};
};

TEST_F(OccluderTest, FindsNothingBeforeAModelThatBothViewsShow) {
  EXPECT_TRUE(find(box_.frame()).empty());
}

TEST_F(OccluderTest, FindsAPlainCardBeforeHalfOfTheModel) {
  const HiddenViews hidden = find(with_card({40, 200, 40}));
  EXPECT_EQ(hidden.covers(points_of(-0.035)), std::vector<bool>(5, true));
  EXPECT_EQ(hidden.covers(points_of(0.035)), std::vector<bool>(5, false));
}

TEST_F(OccluderTest, LeavesHiddenPartsOutOfTheEvidence) {
  const Frame frame = with_card({40, 200, 40});
  const Measures naive = verifier_.model(0).measured(frame, box_.state(), {});
  verifier_.hide(std::make_shared<const HiddenViews>(find(frame)));
  const Measures measures = verifier_.model(0).measured(frame, box_.state(), {});
  EXPECT_LT(naive[Measures::kInside], 0.7);
  EXPECT_GT(measures[Measures::kInside], naive[Measures::kInside] + 0.2);
  EXPECT_NEAR(measures.covered, 0.5, 0.12);
  verifier_.hide(nullptr);
  EXPECT_LT(verifier_.model(0).measured(frame, box_.state(), {}).covered, 0.05);
}

TEST_F(OccluderTest, CountsHiddenPixelsOfTilesAsOutsideThePicture) {
  const Frame frame = with_card({40, 200, 40});
  const HiddenViews hidden = find(frame);
  TilePlan plan = box_.tiles->plan(frame, box_.state());
  for (std::size_t i = 0; i < 2; ++i)
    plan.views[i].hidden = hidden.in_tile(i, plan.header.views[i].camera);
  const Observation seen = box_.tiles->resample(frame, plan);
  for (const TileView& view : seen.views) {
    const int middle = view.camera.width / 2;
    EXPECT_EQ(view.valid.at<uchar>(middle - middle / 3, middle), 0);
    EXPECT_NE(view.valid.at<uchar>(middle + middle / 3, middle), 0);
  }
}

}  // namespace
}  // namespace hypotrack
