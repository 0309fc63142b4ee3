#include "calibrate/picture_pairs.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <vector>

#include "test_paths.hpp"
#include "video_writer.hpp"

namespace hypotrack::calibrate {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

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

TEST(PicturePairs, OfVideosAreOfTheSameTime) {
  const test::TemporaryDirectory folder;
  const std::string left = folder.path() / "left.mkv", right = folder.path() / "right.mkv";
  test::write_video(left, without(2));
  test::write_video(right, without(5));
  std::vector<std::string> names, notes;
  const auto take = [&](const PicturePair& pair) {
    names.push_back(pair.name);
    EXPECT_NEAR(cv::mean(pair.left)[0], cv::mean(pair.right)[0], 1) << pair.name;
  };
  read_pairs(left, right, 1, take, [&](const std::string& note) { notes.push_back(note); });
  EXPECT_THAT(names, ElementsAre("frame 0", "frame 1", "frame 3", "frame 4", "frame 6", "frame 7",
                                 "frame 8"));
  EXPECT_THAT(notes, Contains(HasSubstr("2 frames have no partner")));
  names.clear();
  read_pairs(left, right, 4, take);
  EXPECT_THAT(names, ElementsAre("frame 0", "frame 4", "frame 8"));
}

TEST(PicturePairs, OfVideosAreTurnedAsPlayersDo) {
  const test::TemporaryDirectory folder;
  const std::string file = folder.path() / "portrait.mov";
  test::write_video(
      file, {.times = {0, 20, 40}, .display = {{0, 1 << 16, 0, -1 << 16, 0, 0, 0, 0, 1 << 30}}});
  std::vector<std::string> notes;
  read_pairs(
      file, file, 1, [](const PicturePair& pair) { EXPECT_EQ(pair.left.size(), cv::Size(48, 64)); },
      [&](const std::string& note) { notes.push_back(note); });
  EXPECT_THAT(notes, Contains(HasSubstr("turned by 90 degrees clockwise")));
}

}  // namespace
}  // namespace hypotrack::calibrate
