#include "track/color/still_background.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <vector>

#include "painted_box.hpp"

namespace hypotrack {
namespace {

struct StillBackgrounds : testing::Test {
  test::PaintedBox box;
  StillBackground background{box.scene, box.cameras};

  void learn(const Frame& frame, int times, double x = 0) {
    for (int i = 0; i < times; ++i) background.learn(frame, box.state(x));
  }
  /// What is known around the box, moved along x.
  std::vector<cv::Mat> around(const Frame& frame, double x = 0) const {
    TilePlan plan = box.tiles->plan(frame, box.state(x));
    background.add_to(plan, box.tiles->resamplers());
    return {plan.header.views[0].background, plan.header.views[1].background};
  }
};

double known_share(const cv::Mat& background) {
  cv::Mat alpha;
  cv::extractChannel(background, alpha, 3);
  return cv::countNonZero(alpha) / static_cast<double>(alpha.total());
}

Frame flipped(const Frame& frame) {
  Frame out = frame;
  for (View& view : out.views) {
    view.color = cv::Mat();
    cv::flip(frame.views[0].color, view.color, 1);
  }
  return out;
}

TEST_F(StillBackgrounds, AreUnknownAtFirst) {
  const Frame frame = box.frame();
  for (const cv::Mat& view : around(frame)) EXPECT_TRUE(view.empty());
  learn(frame, 2);
  for (const cv::Mat& view : around(frame)) EXPECT_EQ(known_share(view), 0);
}

TEST_F(StillBackgrounds, AreWhatPicturesShowBesideTheModels) {
  const Frame frame = box.frame();
  learn(frame, 12);
  constexpr double kAway = 0.1;
  const Observation seen = box.tiles->make(frame, box.state(kAway));
  const std::vector<cv::Mat> known = around(frame, kAway);
  for (std::size_t i = 0; i < 2; ++i) {
    SCOPED_TRACE(i);
    EXPECT_GT(known_share(known[i]), 0.4);
    EXPECT_LT(known_share(known[i]), 0.9) << "the box and its margin are unknown";
    for (int y = 0; y < known[i].rows; ++y)
      for (int x = 0; x < known[i].cols; ++x) {
        const auto& b = known[i].at<cv::Vec4b>(y, x);
        if (b[3] == 0) continue;
        for (int c = 0; c < 3; ++c)
          ASSERT_NEAR(b[c], seen.views[i].color.at<cv::Vec3b>(y, x)[c], 2);
      }
  }
  EXPECT_LT(known_share(around(frame)[0]), 0.1) << "where the box was all the time";
}

TEST_F(StillBackgrounds, AreKnownWhereTheModelsHaveGone) {
  const Frame frame = box.frame();
  learn(frame, 12, 0.2);
  EXPECT_EQ(known_share(around(frame)[0]), 1);
}

TEST_F(StillBackgrounds, OfMovingCamerasAreUnknown) {
  const Frame frame = box.frame(), turned = flipped(frame);
  for (int i = 0; i < 10; ++i) {
    learn(frame, 1);
    learn(turned, 1);
  }
  EXPECT_LT(known_share(around(frame, 0.1)[0]), 0.05);
}

TEST_F(StillBackgrounds, AreLearnedAnewAfterTheyChanged) {
  const Frame frame = box.frame();
  const Frame other = flipped(frame);
  learn(frame, 12, 0.2);
  learn(other, 3, 0.2);
  EXPECT_LT(known_share(around(frame)[0]), 0.1);
  learn(other, 20, 0.2);
  EXPECT_GT(known_share(around(frame)[0]), 0.9);
}

TEST_F(StillBackgrounds, HaveThePlansColours) {
  const Frame frame = box.frame();
  learn(frame, 12, 0.2);
  TilePlan plan = box.tiles->plan(frame, box.state());
  background.add_to(plan, box.tiles->resamplers());
  const double before = cv::mean(plan.header.views[1].background)[1];
  plan.views[1].colors.gain[1] = 0.5F;
  background.add_to(plan, box.tiles->resamplers());
  EXPECT_NEAR(cv::mean(plan.header.views[1].background)[1], before / 2, 1);
}

}  // namespace
}  // namespace hypotrack
