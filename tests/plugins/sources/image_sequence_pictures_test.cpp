// What a sequence makes of colour, masks, depth and turned pictures.

#include <gmock/gmock.h>

#include "hypotrack/api/error.hpp"
#include "image_sequence_fixture.hpp"
#include "oriented_pictures.hpp"

namespace hypotrack {
namespace {

using test::ImageSequence;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST_F(ImageSequence, MakesEightBitColourOfEverything) {
  const cv::Mat grey(48, 64, CV_8U, cv::Scalar(77));
  write_image(file("left_0000.png").string(), grey);
  write_image(file("right_0000.png").string(),
              cv::Mat(48, 64, CV_16UC3, cv::Scalar(65535, 32768, 0)));
  write_image(file("left_0001.png").string(), cv::Mat(48, 64, CV_8UC4, cv::Scalar(1, 2, 3, 0)));
  write_image(file("right_0001.png").string(), cv::Mat(48, 64, CV_16U, cv::Scalar(4095)));
  const auto source = make(numbered());
  auto frame = source->next();
  ASSERT_EQ(frame->problem, "");
  EXPECT_EQ(frame->views[0].color.at<cv::Vec3b>(0, 0), cv::Vec3b(77, 77, 77));
  EXPECT_EQ(frame->views[1].color.at<cv::Vec3b>(0, 0), cv::Vec3b(255, 128, 0));
  frame = source->next();
  EXPECT_EQ(frame->views[0].color.at<cv::Vec3b>(0, 0), cv::Vec3b(1, 2, 3)) << "not blended";
  EXPECT_EQ(frame->views[1].color.at<cv::Vec3b>(0, 0), cv::Vec3b(16, 16, 16));
  const auto scaled = make(numbered("bits: 12\nstart: 1\n"))->next();
  EXPECT_EQ(scaled->views[1].color.at<cv::Vec3b>(0, 0), cv::Vec3b(255, 255, 255));

  write_image(file("left_0000.tiff").string(), grey);
  write_image(file("left_0001.tiff").string(), cv::Mat(48, 64, CV_32F, cv::Scalar(0.5)));
  calibrate(64, 48, 1);
  const auto mixed =
      make("type: image_sequence\nleft: left_%04d.tiff\ncalibration: {file: rig.yml}\n");
  EXPECT_EQ(mixed->next()->problem, "");
  EXPECT_THAT(mixed->next()->problem, HasSubstr("has floating-point pixels"));
}

TEST_F(ImageSequence, ReadsMasks) {
  for (int i = 0; i < 3; ++i) write_pair(i);
  cv::Mat mask = cv::Mat::zeros(48, 64, CV_8U);
  mask.colRange(0, 10) = 1;
  for (int i = 0; i < 2; ++i) {
    write_image(file(cv::format("ml_%04d.png", i)).string(), mask);
    write_image(file(cv::format("mr_%04d.png", i)).string(), mask);
  }
  const auto source = make(numbered("left_mask: ml_%04d.png\nright_mask: mr_%04d.png\n"));
  const auto frame = source->next();
  ASSERT_EQ(frame->problem, "");
  EXPECT_EQ(frame->views[1].mask.type(), CV_8U);
  EXPECT_EQ(cv::countNonZero(frame->views[1].mask), 10 * 48);
  source->next();
  EXPECT_THAT(source->next()->problem, HasSubstr("ml_0002.png: is missing"));
  EXPECT_THAT(making(numbered("left_mask: ml_%04d.png\n")),
              ThrowsMessage<ConfigError>(HasSubstr("only one of left_mask and right_mask")));
}

TEST_F(ImageSequence, ReadsDepthInMetresBesideColour) {
  for (int i = 0; i < 3; ++i) {
    write_pair(i);
    cv::Mat depth(48, 64, CV_16U, cv::Scalar(4000));  // eighths of a millimetre: 0.5 m
    depth.row(0) = 0;
    write_image(file(cv::format("d_%04d.png", i)).string(), depth);
  }
  const auto source = make(numbered("left_depth: d_%04d.png\ndepth_units_mm: 0.125\n"));
  const auto frame = source->next();
  ASSERT_EQ(frame->problem, "");
  ASSERT_EQ(frame->views.size(), 2u);
  ASSERT_EQ(frame->views[0].depth.type(), CV_32FC1);
  EXPECT_EQ(frame->views[0].depth.at<float>(1, 2), 0.5f);
  EXPECT_EQ(frame->views[0].depth.at<float>(0, 2), 0);
  EXPECT_TRUE(frame->views[1].depth.empty());
  EXPECT_EQ(cv::norm(frame->views[1].color, picture(0, 1), cv::NORM_INF), 0);
}

TEST_F(ImageSequence, ReadsDepthWithoutColour) {
  calibrate(64, 48, 1);
  for (int i = 0; i < 6; ++i) {
    write_image(file(cv::format("%d.png", 10 * i)).string(),
                cv::Mat(48, 64, CV_16U, cv::Scalar(500 + i)));
  }
  write_image(file("20.png").string(), cv::Mat(48, 64, CV_8U, cv::Scalar(50)));
  write_image(file("30.png").string(), cv::Mat(48, 64, CV_16UC3, cv::Scalar(50, 50, 50)));
  write_image(file("40.png").string(), cv::Mat(24, 32, CV_16U, cv::Scalar(50)));
  const auto source =
      make("type: image_sequence\nleft_depth: \"*.png\"\ncalibration: {file: rig.yml}\n");
  for (int i = 0; i < 2; ++i) {
    const auto frame = source->next();
    ASSERT_EQ(frame->views.size(), 1u);
    EXPECT_TRUE(frame->views[0].color.empty());
    EXPECT_NEAR(frame->views[0].depth.at<float>(20, 20), 0.5 + 0.001 * i, 1e-6);
  }
  EXPECT_THAT(source->next()->problem,
              HasSubstr("20.png: has 8-bit pixels of 1 channel; depth is 16 bits and one channel"));
  EXPECT_THAT(source->next()->problem, HasSubstr("30.png: has 16-bit pixels of 3 channels"));
  EXPECT_THAT(source->next()->problem, HasSubstr("40.png: is 32x24 pixels; expected 64x48"));
  EXPECT_EQ(source->next()->problem, "");
}

TEST_F(ImageSequence, TurnsPicturesAsViewersDoAndSaysSo) {
  for (int i = 0; i < 2; ++i) {
    write_pair(i);
    const std::string stored = test::encoded(".png", picture(i, 1));
    test::write_bytes(file(cv::format("right_%04d.png", i)), test::png_with(test::exif(3), stored));
  }
  const auto source = make(numbered());
  EXPECT_THAT(source->notes(),
              testing::ElementsAre(AllOf(HasSubstr("right_0000.png: its EXIF orientation is 3"),
                                         HasSubstr("turned by 180 degrees"))));
  const auto frame = source->next();
  cv::Mat upright;
  cv::rotate(picture(0, 1), upright, cv::ROTATE_180);
  EXPECT_EQ(cv::norm(frame->views[1].color, upright, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(frame->views[0].color, picture(0, 0), cv::NORM_INF), 0);
}

TEST_F(ImageSequence, SaysThatACalibrationIsOfPicturesNotTurned) {
  for (const char* side : {"left", "right"})
    test::write_bytes(file(std::string(side) + "_0000.png"),
                      test::png_with(test::exif(6), test::encoded(".png", picture(0, 0))));
  EXPECT_THAT(making(numbered()),
              ThrowsMessage<DataError>(AllOf(HasSubstr("48x64"), HasSubstr("turned by 90 degrees "
                                                                           "it fits"))));
}

TEST_F(ImageSequence, NamesTheBitsThatPicturesSeemToHave) {
  for (const char* side : {"left", "right"})
    write_image(file(std::string(side) + "_0000.png").string(),
                cv::Mat(48, 64, CV_16U, cv::Scalar(4000)));
  EXPECT_THAT(make(numbered())->notes(),
              testing::ElementsAre(AllOf(HasSubstr("left_0000.png"), HasSubstr("`bits: 12`")),
                                   HasSubstr("right_0000.png")));
  const auto source = make(numbered("bits: 12\n"));
  EXPECT_THAT(source->notes(), testing::IsEmpty());
  EXPECT_EQ(source->next()->views[0].color.at<cv::Vec3b>(3, 3)[1], 249);
}

TEST_F(ImageSequence, SplitsPicturesOfBothViews) {
  cv::Mat beside, above, depths, masks;
  cv::hconcat(picture(0, 0), picture(0, 1), beside);
  cv::vconcat(picture(0, 0), picture(0, 1), above);
  cv::vconcat(cv::Mat(48, 64, CV_16U, cv::Scalar(500)), cv::Mat(48, 64, CV_16U, cv::Scalar(900)),
              depths);
  cv::vconcat(cv::Mat(48, 64, CV_8U, cv::Scalar(0)), cv::Mat(48, 64, CV_8U, cv::Scalar(1)), masks);
  write_image(file("beside.png").string(), beside);
  write_image(file("above.png").string(), above);
  write_image(file("depth.png").string(), depths);
  write_image(file("mask.png").string(), masks);
  const std::string rig = "type: image_sequence\ncalibration: {file: rig.yml}\n";
  for (const std::string yaml :
       {"left: beside.png\nlayout: side_by_side\n",
        "left: above.png\nlayout: top_bottom\nleft_depth: depth.png\nleft_mask: mask.png\n"}) {
    const auto source = make(rig + yaml);
    ASSERT_EQ(source->cameras().size(), 2u);
    const auto frame = source->next();
    ASSERT_EQ(frame->problem, "");
    for (int v = 0; v < 2; ++v)
      EXPECT_EQ(cv::norm(frame->views[v].color, picture(0, v), cv::NORM_INF), 0) << yaml << v;
    if (frame->views[0].depth.empty()) continue;
    EXPECT_FLOAT_EQ(frame->views[0].depth.at<float>(0, 0), 0.5f);
    EXPECT_FLOAT_EQ(frame->views[1].depth.at<float>(0, 0), 0.9f);
    EXPECT_EQ(cv::countNonZero(frame->views[0].mask), 0);
    EXPECT_EQ(cv::countNonZero(frame->views[1].mask), 64 * 48);
  }
  EXPECT_THAT(making(rig + "left: above.png\nright: above.png\nlayout: top_bottom\n"),
              ThrowsMessage<ConfigError>(HasSubstr("layout is given together with images of the "
                                                   "second camera")));
  write_image(file("odd.png").string(), cv::Mat(95, 64, CV_8U));
  EXPECT_THAT(making(rig + "left: odd.png\nlayout: top_bottom\n"),
              ThrowsMessage<DataError>(HasSubstr("odd.png: its picture is 95 pixels high; expected "
                                                 "an even number")));
}

}  // namespace
}  // namespace hypotrack
