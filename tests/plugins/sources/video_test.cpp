#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <opencv2/videoio.hpp>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/tables.hpp"
#include "source_fixture.hpp"
#include "video_writer.hpp"

namespace hypotrack {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

class Video : public test::SourceFixture {
 protected:
  /// Frame i of a view has brightness 20 + 10 i in blue and 100 * view in green.
  void write_video(const std::string& name, int frames, const std::vector<int>& views,
                   cv::Size size = {64, 48}, double frame_rate = 12) {
    const cv::Size whole(size.width * static_cast<int>(views.size()), size.height);
    cv::VideoWriter writer(file(name).string(), cv::VideoWriter::fourcc('M', 'J', 'P', 'G'),
                           frame_rate, whole);
    ASSERT_TRUE(writer.isOpened());
    for (int i = 0; i < frames; ++i) {
      cv::Mat image(whole, CV_8UC3);
      for (std::size_t v = 0; v < views.size(); ++v) {
        const int x = size.width * static_cast<int>(v);
        image.colRange(x, x + size.width) = cv::Scalar(20 + 10 * i, 100 * views[v], 30);
      }
      writer.write(image);
    }
  }
  /// Which frame of its video a picture is.
  static int number(const View& view) {
    return static_cast<int>(std::lround((cv::mean(view.color)[0] - 20) / 10));
  }
  static int side(const View& view) {
    return static_cast<int>(std::lround(cv::mean(view.color)[1] / 100));
  }
  auto making(const std::string& yaml) {
    return [this, yaml] { make(yaml, &scene_); };
  }
};

const std::string kTwo =
    "type: video\nleft: left.avi\nright: right.avi\ncalibration: {file: rig.yml}\n";

TEST_F(Video, SaysThatItEndsBeforeItsStart) {
  write_video("left.avi", 4, {0});
  write_video("right.avi", 6, {1});
  const auto first = [&](const std::string& more) {
    return test::message_of<DataError>([&] { make(kTwo + more)->next(); });
  };
  EXPECT_THAT(first("start: 4\n"),
              HasSubstr("left.avi: ends before frame 4, the first that start"));
  EXPECT_THAT(first("start: 3\noffset: 4\n"), HasSubstr("right.avi: ends before frame 7"));
}

TEST_F(Video, VideosOfUnequalFrameRatesAreNoPairUnlessTheirRateIsGiven) {
  write_video("left.avi", 4, {0});
  write_video("right.avi", 4, {1}, {64, 48}, 25);
  EXPECT_THAT(making(kTwo),
              ThrowsMessage<DataError>(AllOf(HasSubstr("left.avi has 12 frames per second, "),
                                             HasSubstr("right.avi 25"), HasSubstr("frame by frame"),
                                             HasSubstr("frame_rate"))));
  EXPECT_EQ(make(kTwo + "frame_rate: 12\n")->frame_rate(), 12);
  write_video("right.avi", 4, {1}, {64, 48}, 12.01);  // what a file says is rounded, or a mean
  EXPECT_EQ(make(kTwo)->frame_rate(), 12);
}

TEST_F(Video, RefusesAnAnswerToOtherFrames) {
  write_video("left.avi", 4, {0});
  write_video("right.avi", 6, {1});
  write_states(file("states.csv"), scene_, std::vector<StateRow>{{2, 0, scene_.rest_state()}});
  const std::string yaml = kTwo + "truth_states: states.csv\n";
  EXPECT_FALSE(make(yaml + "start: 1\n", &scene_)->next()->truth);
  EXPECT_THAT(making(yaml + "start: 3\n"),
              ThrowsMessage<DataError>(HasSubstr("states.csv: has frames 2 to 2, and none of them "
                                                 "is one of the source's frames, 3 to 3;")));
}

TEST_F(Video, YieldsPairsUntilEitherEnds) {
  write_video("left.avi", 8, {0});
  write_video("right.avi", 6, {1});
  const auto source = make(kTwo);
  EXPECT_DOUBLE_EQ(source->frame_rate(), 12);
  EXPECT_EQ(source->frame_count(), 6);
  for (int i = 0; i < 6; ++i) {
    const auto frame = source->next();
    ASSERT_TRUE(frame) << i;
    ASSERT_EQ(frame->problem, "");
    EXPECT_EQ(frame->index, i);
    EXPECT_DOUBLE_EQ(frame->time, i / 12.0);
    ASSERT_EQ(frame->views.size(), 2u);
    EXPECT_EQ(number(frame->views[0]), i);
    EXPECT_EQ(number(frame->views[1]), i);
    EXPECT_EQ(side(frame->views[0]), 0);
    EXPECT_EQ(side(frame->views[1]), 1);
  }
  EXPECT_FALSE(source->next());
}

TEST_F(Video, ShiftsSkipsAndThinsOut) {
  write_video("left.avi", 12, {0});
  write_video("right.avi", 12, {1});
  auto source = make(kTwo + "offset: 2\nstart: 1\nstep: 3\n");
  EXPECT_EQ(source->frame_count(), 3);
  for (const int left : {1, 4, 7}) {
    const auto frame = source->next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(number(frame->views[0]), left);
    EXPECT_EQ(number(frame->views[1]), left + 2);
  }
  EXPECT_FALSE(source->next());
  source = make(kTwo + "offset: -4\ncount: 2\nframe_rate: 50\n");
  EXPECT_EQ(source->frame_rate(), 50);
  EXPECT_EQ(source->frame_count(), 2);
  const auto frame = source->next();
  EXPECT_EQ(number(frame->views[0]), 4);
  EXPECT_EQ(number(frame->views[1]), 0);
  EXPECT_TRUE(source->next());
  EXPECT_FALSE(source->next());
}

TEST_F(Video, CutsSideBySideInTwo) {
  write_video("both.avi", 3, {0, 1});
  const auto source = make("type: video\nside_by_side: both.avi\ncalibration: {file: rig.yml}\n");
  const auto frame = source->next();
  ASSERT_EQ(frame->views.size(), 2u);
  EXPECT_EQ(frame->views[0].color.size(), cv::Size(64, 48));
  EXPECT_EQ(side(frame->views[0]), 0);
  EXPECT_EQ(side(frame->views[1]), 1);
}

TEST_F(Video, SplitsViewsOneAboveTheOther) {
  cv::VideoWriter writer(file("both.avi").string(), cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 12,
                         {64, 96});
  cv::Mat image(96, 64, CV_8UC3, cv::Scalar(20, 0, 30));
  image.rowRange(48, 96) = cv::Scalar(20, 100, 30);
  for (int i = 0; i < 2; ++i) writer.write(image);
  writer.release();
  const std::string rig = "type: video\ncalibration: {file: rig.yml}\nlayout: top_bottom\n";
  for (const char* key : {"left", "side_by_side"}) {
    const auto frame = make(rig + key + ": both.avi\n")->next();
    ASSERT_EQ(frame->views.size(), 2u);
    EXPECT_EQ(frame->views[1].color.size(), cv::Size(64, 48));
    EXPECT_EQ(side(frame->views[0]), 0);
    EXPECT_EQ(side(frame->views[1]), 1);
  }
  EXPECT_THAT(making(rig + "left: both.avi\nright: both.avi\n"),
              ThrowsMessage<ConfigError>(HasSubstr("layout is given together with right")));
}

/// A video of a recording of 12 frames, 30 per second, without some of them. Frame i has the
/// brightness 20 + 10 i.
test::VideoRecipe without(const std::vector<int>& gaps) {
  test::VideoRecipe recipe{.codec = "mjpeg", .pixels = AV_PIX_FMT_YUVJ420P};
  std::vector<int> numbers;
  for (int i = 0; i < 12; ++i)
    if (std::ranges::find(gaps, i) == gaps.end()) numbers.push_back(i);
  for (const int i : numbers) recipe.times.push_back(20 * i);
  recipe.paint = [numbers](AVFrame& frame, int i) {
    test::fill_plane(frame, 0, 20 + 10 * numbers[static_cast<std::size_t>(i)]);
    test::fill_plane(frame, 1, 128);
    test::fill_plane(frame, 2, 128);
  };
  return recipe;
}

TEST_F(Video, GivesAFrameThatOneFileLacksAsMissing) {
  test::write_video(file("left.mkv"), without({8}));
  test::write_video(file("right.mkv"), without({3, 4}));
  write_states(file("states.csv"), scene_, std::vector<StateRow>{{9, 0, scene_.rest_state()}});
  const auto source = make(
      "type: video\nleft: left.mkv\nright: right.mkv\ncalibration: {file: rig.yml}\n"
      "truth_states: states.csv\n",
      &scene_);
  EXPECT_EQ(source->frame_count(), 12);
  EXPECT_THAT(source->notes(), testing::Contains(HasSubstr("3 frames have no partner")));
  for (int i = 0; i < 12; ++i) {
    const auto frame = source->next();
    ASSERT_TRUE(frame);
    EXPECT_NEAR(frame->time, i / 30.0, 1e-9);
    EXPECT_EQ(frame->truth.has_value(), i == 9);
    const char* lacking = i == 8 ? "left.mkv" : i == 3 || i == 4 ? "right.mkv" : "";
    EXPECT_THAT(frame->problem, HasSubstr(lacking));
    ASSERT_EQ(frame->views.size(), *lacking ? 0 : 2) << i;
    for (const View& view : frame->views) EXPECT_EQ(number(view), i);
  }
  EXPECT_FALSE(source->next());
  EXPECT_THAT(source->statistics(), testing::IsEmpty());
}

TEST_F(Video, CountsTheFramesOfAGapForItsStart) {
  test::write_video(file("left.mkv"), without({2}));
  test::write_video(file("right.mkv"), without({5}));
  const auto source = make(
      "type: video\nleft: left.mkv\nright: right.mkv\nstart: 4\nstep: 3\n"
      "calibration: {file: rig.yml}\n");
  for (const int i : {4, 7, 10}) EXPECT_EQ(number(source->next()->views.at(1)), i);
  EXPECT_FALSE(source->next());
}

TEST_F(Video, KeepsTheFramesItGave) {
  write_video("left.avi", 4, {0});
  write_video("right.avi", 4, {1});
  const auto source = make(kTwo);
  const auto first = source->next();
  source->next();
  source->next();
  EXPECT_EQ(number(first->views[0]), 0);
}

TEST_F(Video, ReportsDamagedFramesAndGoesOn) {
  write_video("left.avi", 20, {0});
  write_video("right.avi", 20, {1});
  // Overwrite the middle of the file: some frames in it can no longer be decoded.
  const auto size = static_cast<std::streamoff>(std::filesystem::file_size(file("left.avi")));
  std::fstream video(file("left.avi"), std::ios::in | std::ios::out | std::ios::binary);
  video.seekp(size / 2);
  video << std::string(static_cast<std::size_t>(size / 6), '\0');
  video.close();
  const auto source = make(kTwo);
  int frames = 0;
  while (const auto frame = source->next()) {
    EXPECT_EQ(frame->problem.empty(), frame->views.size() == 2);
    if (!frame->problem.empty()) {
      EXPECT_THAT(frame->problem, HasSubstr("left.avi"));
    }
    ASSERT_LE(++frames, 20);
  }
  EXPECT_GE(frames, 8);
}

TEST_F(Video, TakesTheColoursThatItsKeysGive) {
  test::VideoRecipe recipe{.codec = "ffv1", .width = 128, .times = {0, 20}};
  recipe.paint = [](AVFrame& frame, int) {
    test::fill_plane(frame, 0, 134);
    test::fill_plane(frame, 1, 65);
    test::fill_plane(frame, 2, 53);
  };
  test::write_video(file("both.mkv"), recipe);
  const auto color_of = [&](const std::string& more) {
    const auto source =
        make("type: video\nside_by_side: both.mkv\ncalibration: {file: rig.yml}\n" + more);
    EXPECT_EQ(source->notes().empty(), !more.empty());
    return source->next()->views[0].color.at<cv::Vec3b>(20, 20);
  };
  EXPECT_NEAR(color_of("")[1], 223, 2);
  EXPECT_NEAR(color_of("color_matrix: bt709\n")[1], 191, 2);
  EXPECT_NEAR(color_of("color_matrix: bt601\ncolor_range: full\n")[1], 210, 3);
  EXPECT_THAT(making("type: video\nside_by_side: both.mkv\ncalibration: {file: rig.yml}\n"
                     "color_matrix: bt2021\n"),
              ThrowsMessage<ConfigError>(HasSubstr("bt2020")));
}

TEST_F(Video, SaysThatAFileEndsBeforeItsHeaderSays) {
  const std::string one = "type: video\nside_by_side: both.avi\ncalibration: {file: rig.yml}\n";
  const auto statistics_of = [&] {
    const auto source = make(one);
    while (source->next()) EXPECT_THAT(source->statistics(), testing::IsEmpty());
    return source->statistics();
  };
  write_video("both.avi", 7, {0, 1});
  EXPECT_THAT(statistics_of(), testing::IsEmpty());
  std::ifstream in(file("both.avi"), std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(in)), {});
  std::size_t fifth = bytes.find("movi");
  for (int i = 0; i < 5; ++i) fifth = bytes.find("00dc", fifth + 1);
  std::filesystem::resize_file(file("both.avi"), fifth);
  EXPECT_THAT(statistics_of(), testing::ElementsAre(HasSubstr(
                                   "both.avi: ends after 4 frames, its header says 7; the file may "
                                   "be cut off")));
}

TEST_F(Video, SaysWhatItCannotUse) {
  write_video("left.avi", 3, {0});
  write("right.avi", "this is no video");
  EXPECT_THAT(making(kTwo),
              ThrowsMessage<DataError>(HasSubstr("right.avi: cannot be opened as a video")));
  std::filesystem::remove(file("right.avi"));
  EXPECT_THAT(making(kTwo), ThrowsMessage<DataError>(HasSubstr("right.avi: no such file")));
  write_video("right.avi", 3, {1}, {32, 24});
  EXPECT_THAT(making(kTwo), ThrowsMessage<DataError>(HasSubstr("the image is 32x24 pixels")));
  EXPECT_THAT(making("type: video\ncalibration: {file: rig.yml}\n"),
              ThrowsMessage<ConfigError>(HasSubstr("expected either left (and right) or")));
  EXPECT_THAT(making("type: video\nleft: left.avi\noffset: 1\ncalibration: {file: rig.yml}\n"),
              ThrowsMessage<ConfigError>(HasSubstr("offset is for two videos")));
  EXPECT_THAT(making("type: video\nleft: left.avi\ncalibration: {file: rig.yml}\n"),
              ThrowsMessage<DataError>(HasSubstr("holds 2 cameras, the source has 1 views")));
}

}  // namespace
}  // namespace hypotrack
