#include "calibrate/picture_pairs.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>
#include <string_view>
#include <vector>

#include "hypotrack/api/error.hpp"
#include "hypotrack/api/media.hpp"
#include "oriented_pictures.hpp"
#include "test_paths.hpp"
#include "video_writer.hpp"

namespace hypotrack::calibrate {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// A video of frames 0 to 8 of a recording, 30 per second, without one of them. Frame i has the
/// brightness 20 + 20 i.
test::VideoRecipe without(int gap) {
  test::VideoRecipe recipe{.codec = "mjpeg", .pixels = AV_PIX_FMT_YUVJ420P};
  for (int i = 0; i < 9; ++i)
    if (i != gap) recipe.times.push_back(20 * i);
  recipe.paint = [gap](AVFrame& frame, int i) {
    test::fill_plane(frame, 0, 20 + 20 * (i < gap ? i : i + 1));
    test::fill_plane(frame, 1, 128);
    test::fill_plane(frame, 2, 128);
  };
  return recipe;
}

TEST(PicturePairsOfVideos, AreOfTheSameTime) {
  const test::TemporaryDirectory folder;
  const std::string left = folder.path() / "left.mkv", right = folder.path() / "right.mkv";
  test::write_video(left, without(2));
  test::write_video(right, without(5));
  std::vector<std::string> names, notes;
  const auto take = [&](const PicturePair& pair) {
    names.push_back(pair.name);
    EXPECT_NEAR(cv::mean(pair.left)[0], cv::mean(pair.right)[0], 1) << pair.name;
  };
  read_pairs({left, right}, take, [&](const std::string& note) { notes.push_back(note); });
  EXPECT_THAT(names, ElementsAre("frame 0", "frame 1", "frame 3", "frame 4", "frame 6", "frame 7",
                                 "frame 8"));
  EXPECT_THAT(notes, Contains(HasSubstr("2 frames have no partner")));
  names.clear();
  read_pairs({left, right, 4}, take);
  EXPECT_THAT(names, ElementsAre("frame 0", "frame 4", "frame 8"));
}

TEST(PicturePairNames, AreSortedByTheirNumbers) {
  const test::TemporaryDirectory folder;
  for (const char* name : {"left_2", "left_10", "left_1", "right_01", "right_02", "right_10"})
    write_image((folder.path() / (std::string(name) + ".png")).string(), cv::Mat1b(8, 8, uchar{9}));
  std::vector<std::string> names, notes;
  const auto read = [&](const char* left) {
    names.clear(), notes.clear();
    read_pairs(
        {(folder.path() / left).string(), (folder.path() / "right_*.png").string()},
        [&](const PicturePair& pair) { names.push_back(pair.name); },
        [&](const std::string& note) { notes.push_back(note); });
  };
  read("left_*.png");
  EXPECT_THAT(names, ElementsAre("left_1.png", "left_2.png", "left_10.png"));
  EXPECT_THAT(notes, testing::IsEmpty());
  std::filesystem::rename(folder.path() / "left_1.png", folder.path() / "left_3.png");
  read("left_*.png");
  EXPECT_THAT(notes, ElementsAre("left_2.png is paired with right_01.png, not with right_02.png: "
                                 "files pair in the order of their names"));
}

TEST(PicturePairsOfVideos, AreTurnedAsPlayersDo) {
  const test::TemporaryDirectory folder;
  const std::string file = folder.path() / "portrait.mov";
  test::write_video(
      file, {.times = {0, 20, 40}, .display = {{0, 1 << 16, 0, -1 << 16, 0, 0, 0, 0, 1 << 30}}});
  std::vector<std::string> notes;
  read_pairs(
      {file, file}, [](const PicturePair& pair) { EXPECT_EQ(pair.left.size(), cv::Size(48, 64)); },
      [&](const std::string& note) { notes.push_back(note); });
  EXPECT_THAT(notes, Contains(HasSubstr("turned by 90 degrees clockwise")));
}

TEST(PicturePairsOfVideos, AreReadFromFilesOfCamcordersAndPhones) {
  const test::TemporaryDirectory folder;
  test::write_video(folder.path() / "video.mkv", without(9));
  for (const std::string name : {"LEFT.MTS", "a.m2ts", "b.ts", "c.m4v", "d.3gp", "e.mpeg"}) {
    const std::filesystem::path file = folder.path() / name;
    std::filesystem::copy(folder.path() / "video.mkv", file);
    int pairs = 0;
    read_pairs({file, file}, [&](const PicturePair&) { ++pairs; });
    EXPECT_EQ(pairs, 9) << name;
  }
}

TEST(PicturePairsOfVideos, AreOfAllContainersThatRecordersWrite) {
  const test::TemporaryDirectory folder;
  for (const char* ending : {".ts", ".MTS", ".m4v", ".flv", ".mpg"}) {
    const std::string file = folder.path() / (std::string("a") + ending);
    test::VideoRecipe recipe{.codec = "mpeg2video", .tick = {1, 25}};
    if (std::string_view(ending) == ".m4v") recipe.codec = "mpeg4";
    if (std::string_view(ending) == ".flv") recipe.codec = "flv";
    for (int i = 0; i < 50; ++i) recipe.times.push_back(i);
    recipe.paint = [](AVFrame& frame, int i) { test::fill_plane(frame, 0, 20 + 4 * i); };
    test::write_video(file, recipe);
    int pairs = 0;
    read_pairs({file, file}, [&](const PicturePair&) { ++pairs; });
    EXPECT_EQ(pairs, 50) << ending;
  }
}

TEST(PicturePairsOfVideos, OfPlaylistsAreRefusedWithTheWayToOneVideo) {
  const test::TemporaryDirectory folder;
  for (const char* name : {"list.m3u8", "list.txt"}) {
    const std::string file = folder.path() / name;
    std::ofstream(file) << (file.ends_with("8") ? "#EXTM3U\n#EXT-X-TARGETDURATION:1\na.ts\n"
                                                : "file 'a.mp4'\n");
    EXPECT_THAT(
        [&] {
          read_pairs({file, file}, [](const PicturePair&) {});
        },
        ThrowsMessage<DataError>(HasSubstr("names other files; make one video of them")));
  }
}

TEST(PicturePairsOfVideos, TakeTheColoursThatAreGiven) {
  const test::TemporaryDirectory folder;
  const std::string file = folder.path() / "a.mkv";
  test::VideoRecipe recipe{.codec = "ffv1", .times = {0, 20, 40}};
  recipe.paint = [](AVFrame& frame, int) {
    test::fill_plane(frame, 0, 100);
    test::fill_plane(frame, 1, 128);
    test::fill_plane(frame, 2, 128);
  };
  test::write_video(file, recipe);
  PairFiles files{file, file};
  files.colors = {ColorMatrix::bt709, ColorRange::full};
  const auto take = [](const PicturePair& pair) { EXPECT_NEAR(cv::mean(pair.left)[1], 100, 1); };
  std::vector<std::string> notes;
  read_pairs(files, take, [&](const std::string& note) { notes.push_back(note); });
  EXPECT_THAT(notes, testing::Not(Contains(HasSubstr("colour matrix"))));
}

TEST(PicturePairsOfVideos, OfOneVideoHaveNoPartnersToTell) {
  const test::TemporaryDirectory folder;
  const std::string file = folder.path() / "both.mkv";
  test::write_video(file, without(5));
  std::vector<std::string> names, notes;
  read_pairs(
      {.left = file, .right = "", .layout = StereoLayout::side_by_side},
      [&](const PicturePair& pair) { names.push_back(pair.name); },
      [&](const std::string& note) { notes.push_back(note); });
  EXPECT_EQ(names.size(), 8);
  EXPECT_THAT(notes, ElementsAre(HasSubstr("both.mkv: 1 frame is missing in the file")));
}

/// A picture of one brightness.
cv::Mat plain(int brightness, int type = CV_8UC3) {
  return {24, 32, type, cv::Scalar::all(brightness)};
}

class PicturePairs : public testing::Test {
 protected:
  std::string file(const std::string& name) const { return (folder_.path() / name).string(); }
  static std::vector<PicturePair> read(const PairFiles& files) {
    std::vector<PicturePair> out;
    read_pairs(files, [&](PicturePair pair) { out.push_back(std::move(pair)); });
    return out;
  }
  static double brightness(const cv::Mat& image) { return cv::mean(image)[1]; }

  test::TemporaryDirectory folder_;
};

TEST_F(PicturePairs, AreSplitFromPicturesOfBothViews) {
  cv::Mat beside, above;
  cv::hconcat(plain(20), plain(200), beside);
  cv::vconcat(plain(20), plain(200), above);
  write_image(file("beside.png"), beside);
  write_image(file("above.png"), above);
  cv::VideoWriter video(file("above.avi"), cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 10,
                        above.size());
  for (int i = 0; i < 3; ++i) video.write(above);
  video.release();
  const auto expect_pairs = [&](const char* name, StereoLayout layout, std::size_t count) {
    const auto pairs = read({.left = file(name), .right = "", .layout = layout});
    ASSERT_EQ(pairs.size(), count) << name;
    for (const PicturePair& pair : pairs) {
      EXPECT_EQ(pair.left.size(), cv::Size(32, 24));
      EXPECT_NEAR(brightness(pair.left), 20, 3);
      EXPECT_NEAR(brightness(pair.right), 200, 3);
    }
  };
  expect_pairs("beside.png", StereoLayout::side_by_side, 1);
  expect_pairs("above.png", StereoLayout::top_bottom, 1);
  expect_pairs("above.avi", StereoLayout::top_bottom, 3);
  write_image(file("odd.png"), cv::Mat(25, 32, CV_8UC3));
  EXPECT_THAT(
      [&] { read({.left = file("odd.png"), .right = "", .layout = StereoLayout::top_bottom}); },
      ThrowsMessage<DataError>(HasSubstr("its picture is 25 pixels high")));
}

TEST_F(PicturePairs, AreTurnedAsViewersDoAndSaySo) {
  for (const char* name : {"left.png", "right.png"})
    test::write_bytes(file(name), test::png_with(test::exif(6), test::encoded(".png", plain(7))));
  const PairFiles files{.left = file("left.png"), .right = file("right.png")};
  const auto pairs = read(files);
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_EQ(pairs[0].left.size(), cv::Size(24, 32));
  EXPECT_EQ(pairs[0].right.size(), cv::Size(24, 32));
  EXPECT_THAT(notes_on(files),
              testing::ElementsAre(HasSubstr("left.png: its EXIF orientation is 6"),
                                   HasSubstr("right.png: its EXIF orientation is 6")));
}

TEST_F(PicturePairs, OfFewerThanSixteenBitsNameTheOption) {
  for (const char* name : {"left.png", "right.png"}) write_image(file(name), plain(4095, CV_16UC1));
  PairFiles files{.left = file("left.png"), .right = file("right.png")};
  EXPECT_THAT(notes_on(files), testing::Each(HasSubstr("set `--bits 12`")));
  EXPECT_NEAR(brightness(read(files)[0].left), 16, 1);
  files.bits = 12;
  EXPECT_THAT(notes_on(files), testing::IsEmpty());
  EXPECT_EQ(brightness(read(files)[0].right), 255);
}

}  // namespace
}  // namespace hypotrack::calibrate
