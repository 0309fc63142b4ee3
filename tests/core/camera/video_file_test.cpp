#include <gmock/gmock.h>

#include <array>
#include <fstream>
#include <opencv2/core.hpp>
#include <sstream>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/media.hpp"
#include "test_paths.hpp"
#include "video_writer.hpp"

namespace hypotrack {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class VideoFiles : public testing::Test {
 protected:
  std::string file(const std::string& name) const { return (folder_.path() / name).string(); }
  std::unique_ptr<VideoFile> written(const std::string& name, const test::VideoRecipe& recipe) {
    test::write_video(file(name), recipe);
    return open_video(file(name));
  }
  static cv::Mat read(VideoFile& video, std::size_t index) {
    cv::Mat picture;
    EXPECT_EQ(video.read(index, picture), "");
    return picture;
  }
  static std::vector<std::int64_t> every(std::int64_t step, int frames, std::int64_t from = 0) {
    std::vector<std::int64_t> times;
    for (int i = 0; i < frames; ++i) times.push_back(from + step * i);
    return times;
  }

  test::TemporaryDirectory folder_;
};

TEST_F(VideoFiles, TellWhenEachFrameIsShown) {
  for (const char* name : {"a.mp4", "a.mkv", "a.mov"}) {
    const auto video = written(name, {.times = {0, 20, 41, 100, 121}});
    ASSERT_EQ(video->info().times.size(), 5) << name;
    EXPECT_TRUE(video->info().has_clock);
    EXPECT_NEAR(video->info().times[3], 100 / 600.0, 6e-4);
    for (std::size_t i : {0, 3, 4})
      EXPECT_NEAR(read(*video, i).at<cv::Vec3b>(20, 20)[0], (4 + 10 * i) * 255 / 219.0, 3);
    EXPECT_EQ(video->info().problem_of_end, "");
  }
}

TEST_F(VideoFiles, HaveTimesThatProgramStreamsLeaveOut) {
  for (const int reordered : {0, 2}) {
    const auto video = written(
        "a.mpg",
        {.codec = "mpeg2video", .tick = {1, 25}, .times = every(1, 20), .reordered = reordered});
    const std::vector<double>& times = video->info().times;
    ASSERT_EQ(times.size(), 20) << reordered;
    for (std::size_t i = 0; i < times.size(); ++i) {
      EXPECT_NEAR(times[i] - times[0], static_cast<double>(i) / 25, 1e-9);
      EXPECT_NEAR(read(*video, i).at<cv::Vec3b>(20, 20)[0],
                  (4 + 10 * static_cast<double>(i)) * 255 / 219.0, 6);
    }
  }
}

TEST_F(VideoFiles, WithoutTimesAndARateSayWhatIsAssumed) {
  const auto video =
      written("a.mjpeg", {.codec = "mjpeg", .pixels = AV_PIX_FMT_YUVJ420P, .times = every(20, 10)});
  ASSERT_EQ(video->info().times.size(), 10);
  EXPECT_FALSE(video->info().has_clock);
  EXPECT_THAT(video->info().notes,
              Contains(HasSubstr("neither times nor a rate; 25 frames per second are assumed")));
}

TEST_F(VideoFiles, LeaveOutFramesThatAnEditListDoesNotShow) {
  const auto video = written("cut.mp4", {.times = every(20, 10, -80)});
  EXPECT_THAT(video->info().times, testing::SizeIs(6));
  EXPECT_EQ(video->info().times[0], 0);
  EXPECT_NEAR(read(*video, 0).at<cv::Vec3b>(20, 20)[0], 44 * 255 / 219.0, 3);
  EXPECT_EQ(video->info().problem_of_end, "");
}

/// Puts edits, of milliseconds and units of the video, into an MP4 file, whose boxes follow the
/// data.
void edit(const std::string& file, const std::vector<std::array<std::uint32_t, 2>>& edits) {
  const auto number = [](std::uint32_t value) {
    std::string out;
    for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(value >> shift);
    return out;
  };
  std::ostringstream whole;
  whole << std::ifstream(file, std::ios::binary).rdbuf();
  std::string bytes = whole.str(), list = "elst" + number(0) + number(edits.size());
  for (const auto& [length, start] : edits) list += number(length) + number(start) + number(65536);
  const auto size_at = [&](std::size_t at) {
    std::uint32_t size = 0;
    for (const char c : bytes.substr(at, 4)) size = size << 8 | static_cast<unsigned char>(c);
    return size;
  };
  const std::size_t at = bytes.find("elst") - 4, old = size_at(at);
  bytes.replace(at, old, number(list.size() + 4) + list);
  for (const char* box : {"edts", "trak", "moov"}) {
    const std::size_t place = bytes.find(box) - 4;
    bytes.replace(place, 4, number(size_at(place) + list.size() + 4 - old));
  }
  std::ofstream(file, std::ios::binary) << bytes;
}

TEST_F(VideoFiles, SayThatAnEditListRepeatsFrames) {
  const auto of = [&](const std::vector<std::array<std::uint32_t, 2>>& edits) {
    test::write_video(file("edits.mp4"), {.tick = {1, 1000}, .times = every(100, 10)});
    edit(file("edits.mp4"), edits);
    return open_video(file("edits.mp4"));
  };
  const auto parts = of({{500, 0}, {300, 700 * 16}});
  EXPECT_EQ(parts->info().times.size(), 8);
  EXPECT_THAT(parts->info().notes, Not(Contains(HasSubstr("edit list"))));
  // FFmpeg takes a pause for the beginning.
  EXPECT_THAT(of({{500, 0}, {200, 0xFFFFFFFF}, {300, 700 * 16}})->info().notes,
              Contains(HasSubstr("edits.mp4: its edit list shows 2 frames twice")));
}

TEST_F(VideoFiles, BeginAtTheirOwnTimeAndEndWhereTheyEnd) {
  const auto video = written("late.mkv", {.times = every(20, 10, 3000)});
  EXPECT_THAT(video->info().times, testing::SizeIs(10));
  EXPECT_NEAR(video->info().times[0], 5, 1e-9);
  EXPECT_EQ(video->info().problem_of_end, "");
}

/// A picture of four corners, to see where they are shown.
void paint_corners(AVFrame& frame, int) {
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) {
      std::uint8_t* pixel = frame.data[0] + y * frame.linesize[0] + 3 * x;
      pixel[0] = x < frame.width / 2 ? 250 : 10;
      pixel[1] = y < frame.height / 2 ? 250 : 10;
      pixel[2] = 0;
    }
}

TEST_F(VideoFiles, AreTurnedAsPlayersDo) {
  struct Case {
    std::array<std::int32_t, 4> matrix;  ///< a, b, c, d
    bool on_its_side, left_is_first, top_is_first;
    const char* note;
  };
  // With x' = a x + c y and y' = b x + d y: where the stored left and top are shown.
  const Case cases[] = {{{-1, 0, 0, -1}, false, false, false, "turned by 180 degrees"},
                        {{0, 1, -1, 0}, true, true, false, "turned by 90 degrees clockwise"},
                        {{0, -1, 1, 0}, true, false, true, "turned by 90 degrees counterclockwise"},
                        {{-1, 0, 0, 1}, false, false, true, "mirrored from left to right"},
                        {{1, 0, 0, -1}, false, true, false, "mirrored from top to bottom"}};
  for (const Case& c : cases) {
    const auto& m = c.matrix;
    const auto video = written(
        "turned.mov",
        {.codec = "png",
         .pixels = AV_PIX_FMT_RGB24,
         .times = every(20, 2),
         .paint = paint_corners,
         .display = {{m[0] << 16, m[1] << 16, 0, m[2] << 16, m[3] << 16, 0, 0, 0, 1 << 30}}});
    EXPECT_THAT(video->info().notes,
                ElementsAre(AllOf(HasSubstr(c.note), HasSubstr("calibration"))));
    const cv::Mat picture = read(*video, 0);
    EXPECT_EQ(picture.size(), c.on_its_side ? cv::Size(48, 64) : cv::Size(64, 48));
    EXPECT_EQ(video->info().width, picture.cols);
    const auto first = picture.at<cv::Vec3b>(2, 2);
    EXPECT_EQ(first[2] > 128, c.left_is_first) << c.note;
    EXPECT_EQ(first[1] > 128, c.top_is_first) << c.note;
  }
}

TEST_F(VideoFiles, SayThatTheyAreNotTurnedByOddAngles) {
  const auto video = written(
      "slant.mp4",
      {.times = every(20, 2), .display = {{46341, 46341, 0, -46341, 46341, 0, 0, 0, 1 << 30}}});
  EXPECT_THAT(video->info().notes, Contains(HasSubstr("turned by 45 degrees, which is not done")));
}

TEST_F(VideoFiles, SayWhatOfTheirPicturesIsNotHonoured) {
  test::VideoRecipe recipe{.times = every(20, 2), .matrix = AVCOL_SPC_BT709, .aspect = {4, 3}};
  EXPECT_THAT(written("wide.mp4", recipe)->info().notes,
              Contains(HasSubstr("pixels of 4:3, which players stretch")));
  recipe = {.codec = "png", .pixels = AV_PIX_FMT_RGBA, .times = every(20, 2)};
  recipe.paint = [](AVFrame& frame, int) { test::fill_plane(frame, 0, 99); };
  EXPECT_THAT(written("alpha.mov", recipe)->info().notes,
              ElementsAre(HasSubstr("transparency, which is dropped")));
  recipe = {.codec = "ffv1", .times = every(20, 2), .matrix = AVCOL_SPC_BT709};
  recipe.metadata = {"alpha_mode", "1"};  // as VP9 with transparency has
  EXPECT_THAT(written("beside.mkv", recipe)->info().notes,
              ElementsAre(HasSubstr("transparency, which is dropped")));
  recipe = {.codec = "ffv1", .pixels = AV_PIX_FMT_YUV420P10LE, .times = every(20, 2)};
  recipe.matrix = AVCOL_SPC_BT709;
  EXPECT_THAT(written("deep.mkv", recipe)->info().notes, ElementsAre(HasSubstr("10 bits")));
}

TEST_F(VideoFiles, DamagedFramesAreToldAndNotConcealed) {
  test::VideoRecipe recipe{.width = 320, .height = 240, .times = every(20, 10)};
  recipe.paint = [](AVFrame& frame, int i) {
    for (int y = 0; y < frame.height; ++y)
      for (int x = 0; x < frame.width; ++x)
        frame.data[0][y * frame.linesize[0] + x] =
            static_cast<std::uint8_t>(16 + (x * 7 + y * 13 + i * 29 + x * y) % 200);
    test::fill_plane(frame, 1, 128);
    test::fill_plane(frame, 2, 128);
  };
  test::write_video(file("noise.mp4"), recipe);
  const auto size = static_cast<std::streamoff>(std::filesystem::file_size(file("noise.mp4")));
  std::fstream stream(file("noise.mp4"), std::ios::in | std::ios::out | std::ios::binary);
  stream.seekp(size * 3 / 4);
  for (int i = 0; i < 600; ++i) stream.put(static_cast<char>(i * 37 + i * i));
  stream.close();
  const auto video = open_video(file("noise.mp4"));
  ASSERT_EQ(video->info().times.size(), 10);
  std::vector<std::string> problems;
  for (std::size_t i = 0; i < 10; ++i) {
    cv::Mat picture;
    const std::string problem = video->read(i, picture);
    EXPECT_EQ(problem.empty(), !picture.empty());
    if (!problem.empty()) problems.push_back(problem);
  }
  EXPECT_THAT(problems, testing::Each(HasSubstr("noise.mp4: the frame at 0.")));
  EXPECT_GE(problems.size(), 1);
  EXPECT_LE(problems.size(), 2);
}

TEST_F(VideoFiles, DamagedPacketsAreMissingFramesAndMoveNoOthers) {
  const std::array<std::array<const char*, 2>, 8> files{{{"libvpx-vp9", "a.mkv"},
                                                         {"libvpx", "a.mkv"},
                                                         {"mpeg4", "a.mkv"},
                                                         {"libx264", "a.mkv"},
                                                         {"mjpeg", "a.mkv"},
                                                         {"png", "a.mkv"},
                                                         {"png", "a.avi"},
                                                         {"png", "a.mov"}}};
  for (const auto& [codec, name] : files) {
    SCOPED_TRACE(std::string(codec) + " " + name);
    test::VideoRecipe recipe{.codec = codec, .tick = {1, 10}, .times = every(1, 8), .damaged = 3};
    if (recipe.codec == "mjpeg") recipe.pixels = AV_PIX_FMT_YUVJ420P;
    if (recipe.codec == "png") recipe.pixels = AV_PIX_FMT_GRAY8;
    const auto video = written(name, recipe);
    const bool key_frames = recipe.codec == "mjpeg" || recipe.codec == "png";
    const double first = read(*video, 0).at<cv::Vec3b>(20, 20)[0];
    const double step = key_frames ? 10 : 10 * 255 / 219.0;
    ASSERT_EQ(video->info().times.size(), 8);
    for (std::size_t i = 0; i < 8; ++i) {
      EXPECT_NEAR(video->info().times[i], static_cast<double>(i) / 10, 2e-3);
      if (i == 0 || (i > 3 && !key_frames)) continue;
      cv::Mat picture;
      const std::string problem = video->read(i, picture);
      if (i == 3) {
        EXPECT_THAT(problem, HasSubstr("the frame at 0.3"));
      }
      EXPECT_EQ(picture.empty(), i == 3);
      if (!picture.empty()) {
        EXPECT_NEAR(picture.at<cv::Vec3b>(20, 20)[0], first + step * static_cast<double>(i), 4);
      }
    }
  }
}

TEST_F(VideoFiles, SayThatTheyAreCutOff) {
  test::write_video(file("whole.mkv"), {.codec = "ffv1", .times = every(60, 20)});
  std::filesystem::resize_file(file("whole.mkv"),
                               std::filesystem::file_size(file("whole.mkv")) / 2);
  const auto video = open_video(file("whole.mkv"));
  EXPECT_THAT(video->info().problem_of_end,
              AllOf(HasSubstr("its header says"), HasSubstr("cut off")));
}

TEST_F(VideoFiles, AreNotCutOffWhereAviRepeatsFrames) {
  std::vector<std::int64_t> times;
  for (std::int64_t i = 0; i < 40; ++i)
    if (i % 5 != 2 && i % 7 != 3) times.push_back(i);
  const auto video = written("repeats.avi", {.tick = {1, 25}, .times = times});
  EXPECT_EQ(video->info().times.size(), times.size());
  EXPECT_NEAR(video->info().times.back(), static_cast<double>(times.back()) / 25, 1e-9);
  EXPECT_EQ(video->info().problem_of_end, "");
}

TEST_F(VideoFiles, NeverOpenWhatOthersName) {
  test::write_video(file("a.ts"), {.codec = "mpeg2video", .tick = {1, 25}, .times = every(1, 10)});
  const auto refusal = [&](const std::string& name, const std::string& text) {
    std::ofstream(file(name)) << text;
    return test::message_of<DataError>([&] { open_video(file(name)); });
  };
  EXPECT_THAT(refusal("list.m3u8", "#EXTM3U\n#EXT-X-TARGETDURATION:1\n#EXTINF:1,\n" + file("a.ts") +
                                       "\n#EXT-X-ENDLIST\n"),
              AllOf(HasSubstr("list.m3u8: cannot be opened as a video: its format is hls"),
                    HasSubstr("other files")));
  for (const char* text : {"ffconcat version 1.0\nfile a.ts\n", "# all\n\n  file 'a.ts'\n"})
    EXPECT_THAT(refusal("list.txt", text),
                AllOf(HasSubstr("concat, a list that names other files"),
                      HasSubstr("ffmpeg -f concat -safe 0 -i LIST -c copy OUT.mkv")));
  for (const char* text : {"#EXTM3U\n#EXTINF:1,\na.ts\n", "a.ts\n"})
    EXPECT_THAT(refusal("list.m3u", text),
                HasSubstr("a playlist that names other files; give a video that it names"));
  EXPECT_THAT(refusal("live.sdp", "v=0\no=- 0 0 IN IP4 127.0.0.1\ns=x\nm=video 5000 RTP/AVP 96\n"),
              HasSubstr("describes a live stream"));
  EXPECT_THAT(refusal("text.mp4", "no video"), HasSubstr("cannot be opened as a video"));
  EXPECT_THAT(test::message_of<DataError>([&] { open_video("concat:" + file("a.ts")); }),
              HasSubstr("no such file"));
}

TEST_F(VideoFiles, LargerThanPicturesMayBeAreRefused) {
  std::ofstream(file("huge.y4m")) << "YUV4MPEG2 W16000 H16000 F30:1 C420\nFRAME\nxyz";
  EXPECT_THAT(test::message_of<DataError>([&] { open_video(file("huge.y4m")); }),
              HasSubstr("has 16000x16000 pixels; at most"));
}

}  // namespace
}  // namespace hypotrack
