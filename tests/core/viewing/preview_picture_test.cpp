#include "viewing/preview_picture.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "live_world.hpp"

namespace hypotrack::test {
namespace {

class PreviewPictureTest : public testing::Test {
 protected:
  PreviewText text(const LiveFrame& frame) const {
    PreviewText out;
    out.models = {"hand"};
    out.newest = frame;
    return out;
  }
  cv::Mat draw(const PreviewText& what) const { return preview_picture({}, what, area_); }

  /// Returns the number of pixels of a colour, as a probability's bar has.
  static int count(const cv::Mat& picture, const cv::Scalar& color) {
    cv::Mat equal;
    cv::inRange(picture, color, color, equal);
    return cv::countNonZero(equal);
  }

  LiveWorld world_;
  cv::Size area_{1200, 500};
};

TEST_F(PreviewPictureTest, WindowsFitOnTheScreenWithBothViewsWhole) {
  for (const cv::Size screen : {cv::Size(1280, 720), cv::Size(1920, 1080), cv::Size(3840, 1080)})
    for (const std::size_t models : {1, 4}) {
      const cv::Size size = preview_size(world_.cameras, models, screen);
      EXPECT_LT(size.width, screen.width);
      EXPECT_LT(size.height, screen.height);
      const std::vector<Camera> cameras = preview_cameras(world_.cameras, models, size);
      EXPECT_LE(cameras[0].width + cameras[1].width, size.width);
      EXPECT_LT(cameras[0].height, size.height);
      EXPECT_GT(cameras[0].height, size.height / 2) << "the views have most of the window";
      EXPECT_NEAR(1.0 * cameras[0].width / cameras[0].height, 4.0 / 3, 0.01);
    }
}

TEST_F(PreviewPictureTest, HasTheWindowsSizeHoweverSmall) {
  for (const cv::Size area : {cv::Size(64, 64), cv::Size(300, 100), cv::Size(1800, 700)}) {
    const std::vector<Camera> cameras = preview_cameras(world_.cameras, 1, area);
    const std::vector<cv::Mat> views = {
        cv::Mat(cameras[0].height, cameras[0].width, CV_8UC3, cv::Scalar::all(90)),
        cv::Mat(cameras[1].height, cameras[1].width, CV_8UC3, cv::Scalar::all(90))};
    PreviewText all = text(world_.live(5));
    all.help = true;
    EXPECT_EQ(preview_picture(views, all, area).size(), area);
  }
}

TEST_F(PreviewPictureTest, BarsShowProbabilityAndSigma) {
  const cv::Scalar kTracked(110, 220, 110);
  const int none = count(draw(text(world_.live(5, Status::tracked, 0))), kTracked);
  const int half = count(draw(text(world_.live(5, Status::tracked, 0.5))), kTracked);
  const int whole = count(draw(text(world_.live(5, Status::tracked, 1))), kTracked);
  EXPECT_GT(half, none);
  EXPECT_NEAR(whole - none, 2 * (half - none), 0.02 * whole);
  LiveFrame known = world_.live(5);
  known.sigmas = {0.02};
  EXPECT_NEAR(count(draw(text(known)), kTracked) - none, 2 * (whole - none), 0.02 * whole);
}

TEST_F(PreviewPictureTest, StatusPauseRecordingErrorAndHelpAreSeen) {
  const PreviewText plain = text(world_.live(5));
  std::vector<PreviewText> others(6, plain);
  others[0].newest->solution.models = {Status::lost};
  others[1].status.paused = true;
  others[2].status.recorded = 3;
  others[3].newest->error = 0.001;
  others[4].help = true;
  others[5].message = "a message";
  const cv::Mat before = draw(plain);
  for (std::size_t i = 0; i < others.size(); ++i)
    EXPECT_GT(cv::norm(draw(others[i]), before, cv::NORM_INF), 100) << i;
}

TEST_F(PreviewPictureTest, WaitsForTheFirstFrameAndUnknownNumbers) {
  PreviewText waits;
  waits.models = {"hand"};
  EXPECT_EQ(draw(waits).size(), area_);
  LiveFrame unknown = world_.live(0, Status::missing);
  unknown.solution.probabilities = {};
  EXPECT_GT(cv::norm(draw(text(unknown)), draw(waits), cv::NORM_INF), 100);
}

}  // namespace
}  // namespace hypotrack::test
