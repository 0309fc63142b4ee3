#include <gmock/gmock.h>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "pictures.hpp"

namespace hypotrack {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(DetectorInput, ThatIsNoPictureIsRefused) {
  HYPOTRACK_NEEDS_HAND_DETECTOR();
  HandDetector detector({});
  const auto message = [&](const cv::Mat& picture) {
    const std::string text =
        test::message_of<DataError>([&] { detector.refine(picture, HandPoints::Zero()); });
    EXPECT_EQ(test::message_of<DataError>([&] { detector.detect(picture); }), text);
    return text;
  };
  EXPECT_THAT(message({}), HasSubstr("empty picture"));
  EXPECT_THAT(message(cv::Mat::zeros(9, 9, CV_32FC3)),
              AllOf(HasSubstr("CV_32FC3"), HasSubstr("8-bit")));
  EXPECT_THAT(message(cv::Mat::zeros(9, 9, CV_8UC4)), HasSubstr("CV_8UC4"));
  EXPECT_THAT(message(cv::Mat::zeros(9, 9, CV_16UC1)), HasSubstr("CV_16UC1"));
}

TEST(DetectorInput, OfAnyShapeIsTaken) {
  HYPOTRACK_NEEDS_HAND_DETECTOR();
  HandDetector detector({});
  for (const cv::Size size :
       {cv::Size(1, 1), cv::Size(1, 700), cv::Size(3000, 2), cv::Size(65, 33)}) {
    EXPECT_TRUE(detector.detect(cv::Mat(size, CV_8UC1, cv::Scalar(200))).empty()) << size;
  }
}

TEST(DetectorOptions, OutOfRangeAreRefused) {
  const auto message = [](HandDetector::Options options) {
    return test::message_of<ConfigError>([&] { HandDetector detector(options); });
  };
  EXPECT_THAT(message({.palm_threshold = 1.5}), HasSubstr("palm_threshold is 1.5"));
  EXPECT_THAT(message({.presence = -1}), HasSubstr("presence is -1"));
  EXPECT_THAT(message({.presence = NAN}), HasSubstr("presence is nan"));
  EXPECT_THAT(message({.most_hands = 0}), HasSubstr("most_hands is 0"));
  EXPECT_THAT(message({.smallest_hand = -2}), HasSubstr("smallest_hand is -2"));
}

}  // namespace
}  // namespace hypotrack
