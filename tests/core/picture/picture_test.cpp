#include <gtest/gtest.h>

#include <limits>
#include <opencv2/core.hpp>

#include "hypotrack/api/overlay.hpp"

namespace hypotrack::test {
namespace {

TEST(Picture, IsTheColourWhereThereIsColour) {
  View view;
  view.color = cv::Mat(3, 4, CV_8UC3, cv::Scalar(1, 2, 3));
  view.depth = cv::Mat(3, 4, CV_32F, cv::Scalar(0.5));
  EXPECT_EQ(picture_of(view).data, view.color.data);
}

TEST(Picture, OfDepthIsBrighterTheNearerAndBlackWhereNothingWasMeasured) {
  View view;
  view.depth = cv::Mat(20, 50, CV_32F);
  for (int x = 0; x < 50; ++x) view.depth.col(x) = 0.4 + 0.02 * x;
  view.depth.row(0) = 0;
  view.depth.at<float>(1, 0) = 1e-4F;  // a wrong pixel that must not darken the rest
  view.depth.at<float>(2, 0) = std::numeric_limits<float>::quiet_NaN();
  const cv::Mat picture = picture_of(view);
  ASSERT_EQ(picture.type(), CV_8UC3);
  ASSERT_EQ(picture.size(), view.depth.size());
  for (int x = 0; x < 50; ++x) EXPECT_EQ(picture.at<cv::Vec3b>(0, x), cv::Vec3b(0, 0, 0));
  EXPECT_EQ(picture.at<cv::Vec3b>(2, 0), cv::Vec3b(0, 0, 0));
  for (int x = 1; x < 50; ++x) {
    const cv::Vec3b here = picture.at<cv::Vec3b>(10, x);
    EXPECT_LE(here[0], picture.at<cv::Vec3b>(10, x - 1)[0]) << x;
    EXPECT_EQ(here, cv::Vec3b::all(here[0]));
    EXPECT_GT(here[0], 0);
  }
  EXPECT_GT(picture.at<cv::Vec3b>(10, 1)[0], 230);
  EXPECT_LT(picture.at<cv::Vec3b>(10, 48)[0], 60);
}

TEST(Picture, OfDepthIsBlackWhereNothingWasMeasuredAtAll) {
  View view;
  view.depth = cv::Mat::zeros(3, 4, CV_32F);
  EXPECT_EQ(cv::norm(picture_of(view), cv::NORM_INF), 0);
  EXPECT_EQ(picture_of(view).size(), view.depth.size());
  EXPECT_TRUE(picture_of({}).empty());
}

}  // namespace
}  // namespace hypotrack::test
