#include <gmock/gmock.h>
#include <oneapi/tbb/task_arena.h>

#include <random>

#include "hypotrack/api/error.hpp"
#include "image_sequence_fixture.hpp"

namespace hypotrack {
namespace {

using test::ImageSequence;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST_F(ImageSequence, YieldsPairsInOrderAndThenEnds) {
  for (int i = 3; i < 7; ++i) write_pair(i);
  const auto source = make(numbered("frame_rate: 10"));
  ASSERT_EQ(source->cameras().size(), 2u);
  EXPECT_EQ(source->cameras()[1].width, 64);
  EXPECT_EQ(source->frame_rate(), 10);
  EXPECT_EQ(source->frame_count(), 4);
  for (int i = 0; i < 4; ++i) {
    const auto frame = source->next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->problem, "");
    EXPECT_EQ(frame->index, i);
    EXPECT_DOUBLE_EQ(frame->time, 0.1 * i);
    EXPECT_FALSE(frame->truth);
    ASSERT_EQ(frame->views.size(), 2u);
    for (int v = 0; v < 2; ++v) {
      EXPECT_EQ(cv::norm(frame->views[v].color, picture(i + 3, v), cv::NORM_INF), 0);
      EXPECT_TRUE(frame->views[v].mask.empty());
    }
  }
  EXPECT_FALSE(source->next());
  EXPECT_FALSE(source->next());
}

TEST_F(ImageSequence, SelectsByStartStepAndCount) {
  for (int i = 0; i < 10; ++i) write_pair(i);
  const auto source = make(numbered("start: 1\nstep: 3\ncount: 2\nframe_rate: 30"));
  EXPECT_EQ(source->frame_count(), 2);
  EXPECT_DOUBLE_EQ(source->frame_rate(), 10);
  EXPECT_EQ(source->next()->views[0].color.at<cv::Vec3b>(40, 40)[0], 10);
  const auto second = source->next();
  EXPECT_EQ(second->views[0].color.at<cv::Vec3b>(40, 40)[0], 40);
  EXPECT_DOUBLE_EQ(second->time, 0.1);
  EXPECT_FALSE(source->next());
}

TEST_F(ImageSequence, ReportsGapsAndGoesOn) {
  for (const int i : {0, 1, 3}) write_pair(i);
  std::filesystem::remove(file("right_0001.png"));
  const auto source = make(numbered());
  EXPECT_EQ(source->frame_count(), 4);
  EXPECT_EQ(source->next()->problem, "");
  const auto half = source->next();
  EXPECT_THAT(half->problem, HasSubstr("right_0001.png: is missing"));
  EXPECT_TRUE(half->views.empty());
  EXPECT_THAT(source->next()->problem, HasSubstr("left_0002.png: is missing"));
  const auto last = source->next();
  EXPECT_EQ(last->problem, "");
  EXPECT_EQ(last->index, 3);
  EXPECT_FALSE(source->next());
}

TEST_F(ImageSequence, YieldsTheSameWhereManyThreadsDecodeAhead) {
  constexpr int kFrames = 11;
  for (int i = 0; i < kFrames; ++i) write_pair(i);
  write("left_0005.png", "this is no picture");
  const auto source = make(numbered());
  tbb::task_arena(8).execute([&] {
    for (int i = 0; i < kFrames; ++i) {
      const auto frame = source->next();
      ASSERT_TRUE(frame);
      EXPECT_EQ(frame->index, i);
      EXPECT_EQ(frame->problem.empty(), i != 5) << frame->problem;
      if (i == 5) continue;
      EXPECT_EQ(cv::norm(frame->views[1].color, picture(i, 1), cv::NORM_INF), 0);
    }
    EXPECT_FALSE(source->next());
  });
}

TEST_F(ImageSequence, ReportsImagesThatCannotBeUsedAndGoesOn) {
  for (int i = 0; i < 7; ++i) write_pair(i);
  write("left_0001.png", "this is no picture");
  write("right_0002.png", "");
  std::filesystem::resize_file(file("left_0003.png"), 100);
  write_image(file("right_0004.png").string(), picture(4, 1, {32, 24}));
  std::filesystem::remove(file("left_0005.png"));
  std::filesystem::create_directory(file("left_0005.png"));
  const auto source = make(numbered());
  EXPECT_EQ(source->next()->problem, "");
  EXPECT_THAT(source->next()->problem, HasSubstr("left_0001.png: is damaged or no image"));
  EXPECT_THAT(source->next()->problem, HasSubstr("right_0002.png: is empty"));
  EXPECT_THAT(source->next()->problem, HasSubstr("left_0003.png: is cut off before its end"));
  EXPECT_THAT(source->next()->problem,
              HasSubstr("right_0004.png: is 32x24 pixels; expected 64x48"));
  EXPECT_THAT(source->next()->problem, HasSubstr("left_0005.png: is no file"));
  EXPECT_EQ(source->next()->problem, "");
  EXPECT_FALSE(source->next());
}

TEST_F(ImageSequence, NeverEndsEarlyOrThrowsWhateverBytesAreDamaged) {
  constexpr int kFrames = 60;
  std::mt19937 random(4);
  for (int i = 0; i < kFrames; ++i) {
    const char* extension = i % 2 ? "jpg" : "png";
    write_pair(i, extension);
    for (const char* side : {"left", "right"}) {
      std::ifstream in(file(cv::format("%s_%04d.%s", side, i, extension)), std::ios::binary);
      std::string bytes((std::istreambuf_iterator<char>(in)), {});
      for (int k = 0; i > 0 && k < 5; ++k) {
        bytes[random() % bytes.size()] = static_cast<char>(random() % 256);
      }
      write(cv::format("%s_%04d.img", side, i), bytes);
    }
  }
  const auto source = make(
      "type: image_sequence\nleft: left_%04d.img\nright: right_%04d.img\n"
      "calibration: {file: rig.yml}\n");
  int frames = 0;
  int problems = 0;
  while (const auto frame = source->next()) {
    ++frames;
    problems += !frame->problem.empty();
    EXPECT_EQ(frame->problem.empty(), frame->views.size() == 2);
  }
  EXPECT_EQ(frames, kFrames);
  EXPECT_GT(problems, 5);
}

TEST_F(ImageSequence, SortsGlobsByTheirNumbers) {
  for (const int i : {2, 9, 10, 1}) {
    write_image(file(cv::format("a%d.png", i)).string(), picture(i, 0));
    write_image(file(cv::format("b%d.png", i)).string(), picture(i, 1));
  }
  const std::string yaml =
      "type: image_sequence\nleft: a*.png\nright: b?*.png\ncalibration: {file: rig.yml}\n";
  const auto source = make(yaml);
  for (const int expected : {1, 2, 9, 10}) {
    const auto frame = source->next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->views[0].color.at<cv::Vec3b>(40, 40)[0], 10 * expected);
    EXPECT_EQ(frame->views[1].color.at<cv::Vec3b>(40, 40)[1], 100);
  }
  EXPECT_FALSE(source->next());
  std::filesystem::remove(file("b9.png"));
  EXPECT_THAT(making(yaml),
              ThrowsMessage<DataError>(AllOf(HasSubstr("finds 4 images"), HasSubstr("finds 3"))));
}

TEST_F(ImageSequence, ReadsOneFileAndOneView) {
  calibrate(64, 48, 1);
  write_image(file("100%.png").string(), picture(7, 0));
  const auto source = make("type: image_sequence\nleft: 100%%.png\ncalibration: {file: rig.yml}\n");
  const auto frame = source->next();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->views.size(), 1u);
  EXPECT_FALSE(source->next());
}

TEST_F(ImageSequence, SaysThatTimeStampsAreNoNumbersOfFrames) {
  for (const char* stamp : {"1690000000123456789", "1690000000156789000"})
    for (int v = 0; v < 2; ++v)
      write_image(file(cv::format("%s_%s.png", v ? "right" : "left", stamp)).string(),
                  picture(0, v));
  const auto yaml = [](const std::string& number) {
    return "type: image_sequence\nleft: left_" + number + ".png\nright: right_" + number +
           ".png\ncalibration: {file: rig.yml}\n";
  };
  EXPECT_THAT(making(yaml("%d")), ThrowsMessage<DataError>(
                                      AllOf(HasSubstr("looked for"), HasSubstr("left_%d.png in "),
                                            HasSubstr("left_1690000000123456789.png is there, but"),
                                            HasSubstr("none from 0 to 2147483647"),
                                            HasSubstr("with * instead of the number"))));
  EXPECT_EQ(make(yaml("*"))->frame_count(), 2);
}

TEST_F(ImageSequence, RefusesAPatternThatFindsMasksAmongThePictures) {
  for (int i = 0; i < 2; ++i) write_pair(i);
  const std::string yaml =
      "type: image_sequence\nleft: left_*.png\nright: right_*.png\n"
      "calibration: {file: rig.yml}\n";
  EXPECT_EQ(make(yaml)->frame_count(), 2);
  for (const char* other : {"left_mask_0000.png", "left_depth_0000.png"}) {
    write_image(file(other).string(), picture(0, 0));
    EXPECT_THAT(making(yaml), ThrowsMessage<DataError>(
                                  AllOf(HasSubstr("left_*.png finds left_0000.png and "),
                                        HasSubstr(other), HasSubstr("Use a number instead of *"))));
    std::filesystem::remove(file(other));
  }
}

TEST_F(ImageSequence, FindsNumberedFolders) {
  for (int i = 8; i < 12; ++i) {
    const auto folder = file(cv::format("%d", i));
    std::filesystem::create_directory(folder);
    write_image((folder / "left.png").string(), picture(i, 0));
    write_image((folder / "right.png").string(), picture(i, 1));
  }
  const auto source = make(
      "type: image_sequence\nleft: \"%d/left.png\"\nright: \"%d/right.png\"\n"
      "calibration: {file: rig.yml}\n");
  EXPECT_EQ(source->frame_count(), 4);
  EXPECT_EQ(source->next()->problem, "");
}

TEST_F(ImageSequence, ReadsFormatsBesidePng) {
  for (const char* extension : {"webp", "bmp", "tiff", "ppm"}) {
    for (int v = 0; v < 2; ++v)
      write_image(file(cv::format("%s_0000.%s", v ? "right" : "left", extension)).string(),
                  picture(0, v), {cv::IMWRITE_WEBP_QUALITY, 101});  // lossless
    const auto frame =
        make(cv::format("type: image_sequence\nleft: left_%%04d.%s\nright: right_%%04d.%s\n"
                        "calibration: {file: rig.yml}\n",
                        extension, extension))
            ->next();
    ASSERT_TRUE(frame);
    ASSERT_EQ(frame->problem, "") << extension;
    for (int v = 0; v < 2; ++v)
      EXPECT_EQ(cv::norm(frame->views[v].color, picture(0, v), cv::NORM_INF), 0) << extension;
  }
}

}  // namespace
}  // namespace hypotrack
