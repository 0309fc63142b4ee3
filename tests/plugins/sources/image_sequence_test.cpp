#include <gmock/gmock.h>
#include <oneapi/tbb/task_arena.h>

#include <random>

#include "hypotrack/error.hpp"
#include "hypotrack/media.hpp"
#include "hypotrack/tables.hpp"
#include "oriented_pictures.hpp"
#include "source_fixture.hpp"

namespace hypotrack {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

class ImageSequence : public test::SourceFixture {
 protected:
  void write_pair(int number, const char* extension = "png") {
    for (int v = 0; v < 2; ++v) {
      write_image(file(cv::format("%s_%04d.%s", v ? "right" : "left", number, extension)).string(),
                  picture(number, v));
    }
  }
  std::string numbered(const std::string& more = "") const {
    return "type: image_sequence\nleft: left_%04d.png\nright: right_%04d.png\n"
           "calibration: {file: rig.yml}\n" +
           more;
  }
  auto making(const std::string& yaml) {
    return [this, yaml] { make(yaml, &scene_); };
  }
};

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

TEST_F(ImageSequence, SaysWhichPicturesAreMissingFromTheScene) {
  write_pair(0);
  EXPECT_THAT(making("type: image_sequence\ncalibration: {file: rig.yml}\n"),
              ThrowsMessage<ConfigError>(
                  AllOf(HasSubstr("scene.yaml:1"), HasSubstr("neither left nor left_depth"))));
  EXPECT_THAT(making("type: image_sequence\nleft: left_%04d.png\nright_mask: left_%04d.png\n"
                     "calibration: {file: rig.yml}\n"),
              ThrowsMessage<ConfigError>(HasSubstr("right_mask is given without images")));
  EXPECT_THAT(making(numbered("right_depth: right_%04d.png\n")),
              ThrowsMessage<DataError>(AllOf(HasSubstr("no image can be read"),
                                             HasSubstr("right_0000.png: has 8-bit pixels"))));
  write_image(file("d_0000.png").string(), cv::Mat(24, 32, CV_16U, cv::Scalar(50)));
  EXPECT_THAT(making(numbered("left_depth: d_%04d.png\n")),
              ThrowsMessage<DataError>(AllOf(HasSubstr("d_0000.png"), HasSubstr("32x24"))));
}

TEST_F(ImageSequence, KnowsTheAnswerWhereTablesGiveIt) {
  for (int i = 0; i < 3; ++i) write_pair(i);
  Eigen::VectorXd state = scene_.rest_state();
  state[2] = 0.5;
  write_states(file("states.csv"), scene_, std::vector<StateRow>{{0, 0, state}, {2, 0.1, state}});
  const std::string name = scene_.landmark_names()[0];
  write("landmarks.csv", "frame," + name + "_x," + name + "_y," + name + "_z\n1,10,20,30\n");
  const auto source = make(numbered("truth_states: states.csv\ntruth_landmarks: landmarks.csv\n"
                                    "truth_units: mm\n"),
                           &scene_);
  const auto first = source->next();
  ASSERT_TRUE(first->truth);
  EXPECT_EQ(first->truth->state, state);
  EXPECT_EQ(first->truth->landmarks.size(), 0);
  const auto second = source->next();
  ASSERT_TRUE(second->truth);
  EXPECT_EQ(second->truth->state.size(), 0);
  EXPECT_NEAR(second->truth->landmarks(1, 0), 0.02, 1e-15);
}

TEST_F(ImageSequence, FindsTheAnswerByTheNumberOfTheImage) {
  for (int i = 0; i < 9; ++i) write_pair(i);
  Eigen::VectorXd state = scene_.rest_state();
  std::vector<StateRow> rows;
  for (int i = 0; i < 9; ++i) {
    state[2] = i;
    rows.push_back({i, i / 30.0, state});
  }
  write_states(file("states.csv"), scene_, rows);
  const auto source = make(numbered("start: 3\nstep: 2\ntruth_states: states.csv\n"), &scene_);
  EXPECT_EQ(source->next()->truth->state[2], 3);
  EXPECT_EQ(source->next()->truth->state[2], 5);
  const auto shifted =
      make(numbered("start: 3\ntruth_states: states.csv\ntruth_offset: -2\n"), &scene_);
  EXPECT_EQ(shifted->next()->truth->state[2], 1);
}

TEST_F(ImageSequence, RefusesAnAnswerToOtherFrames) {
  for (int i = 0; i < 3; ++i) write_pair(i);
  write_states(file("states.csv"), scene_, std::vector<StateRow>{{1, 0, scene_.rest_state()}});
  const auto with = [&](const std::string& more) {
    return [this, more] { make(numbered("truth_states: states.csv\n" + more), &scene_); };
  };
  EXPECT_NO_THROW(with("")());
  EXPECT_THAT(with("truth_offset: 7\n"),
              ThrowsMessage<DataError>(AllOf(HasSubstr("states.csv: has frames 1 to 1"),
                                             HasSubstr("the source's frames, 7 to 9;"))));
  EXPECT_THAT(with("start: 2\n"), ThrowsMessage<DataError>(HasSubstr("frames, 2 to 2;")));
  EXPECT_THAT(with("step: 2\n"), ThrowsMessage<DataError>(HasSubstr("0 to 2 in steps of 2")));
}

TEST_F(ImageSequence, SaysWhatItDidNotFind) {
  EXPECT_THAT(making(numbered()),
              ThrowsMessage<DataError>(
                  AllOf(HasSubstr("no image was found; looked for\n  left_%04d.png in "),
                        HasSubstr(folder_.path().string()), HasSubstr("right_%04d.png"))));
  EXPECT_THAT(making("type: image_sequence\nleft: none/*.png\ncalibration: {file: rig.yml}\n"),
              ThrowsMessage<DataError>(HasSubstr("(no such folder)")));
  write_pair(5);
  EXPECT_THAT(making(numbered("start: 9")),
              ThrowsMessage<DataError>(HasSubstr("the last image has number 5")));
  EXPECT_THAT(making("type: image_sequence\nleft: left_%s.png\ncalibration: {file: rig.yml}\n"),
              ThrowsMessage<DataError>(HasSubstr("the pattern is not understood")));
  EXPECT_THAT(making("type: image_sequence\nleft: left_%04d.png\nright: right_*.png\n"
                     "calibration: {file: rig.yml}\n"),
              ThrowsMessage<DataError>(HasSubstr("only one of the patterns has a number")));
  write_image(file("sparse_1.png").string(), picture(0, 0));
  write_image(file("sparse_2000000000.png").string(), picture(0, 0));
  EXPECT_THAT(making("type: image_sequence\nleft: sparse_%d.png\ncalibration: {file: rig.yml}\n"),
              ThrowsMessage<DataError>(HasSubstr("most frames would be missing")));
}

TEST_F(ImageSequence, SaysThatTheCalibrationDoesNotFit) {
  write_pair(5);
  calibrate(64, 48, 3);
  EXPECT_THAT(making(numbered()),
              ThrowsMessage<DataError>(HasSubstr("holds 3 cameras, the source has 2 views")));
  calibrate(320, 240, 2);
  EXPECT_THAT(making(numbered()),
              ThrowsMessage<DataError>(HasSubstr(
                  "the image is 64x48 pixels, but its camera is calibrated for 320x240")));
  calibrate(64, 48, 2);
  write("right_0005.png", "no picture");
  EXPECT_THAT(making(numbered()), ThrowsMessage<DataError>(HasSubstr("no image can be read: ")));
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
