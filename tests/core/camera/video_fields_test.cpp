#include <gmock/gmock.h>

#include <opencv2/core.hpp>

#include "field_video.hpp"
#include "hypotrack/api/media.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

using testing::Contains;
using testing::HasSubstr;

constexpr int kPictures = 12;

/// Checks times, pictures and the note of a video of write_field_video().
void expect_pictures(const std::string& file, bool has_clock) {
  SCOPED_TRACE(file);
  const auto video = open_video(file);
  const std::vector<double>& times = video->info().times;
  EXPECT_THAT(video->info().notes, Contains(HasSubstr("is interlaced")));
  EXPECT_EQ(video->info().problem_of_end, "");
  EXPECT_EQ(video->info().has_clock, has_clock);
  ASSERT_EQ(times.size(), kPictures);
  for (std::size_t i = 0; i < times.size(); ++i) {
    EXPECT_NEAR(times[i] - times[0], static_cast<double>(i) / 25, 1e-3);
    cv::Mat picture;
    ASSERT_EQ(video->read(i, picture), "");
    EXPECT_EQ(picture.size(), cv::Size(64, 64));
    const double expected = (40 + 8 * static_cast<double>(i) - 16) * 255 / 219;
    EXPECT_NEAR(picture.at<cv::Vec3b>(30, 20)[1], expected, 2);
    EXPECT_NEAR(picture.at<cv::Vec3b>(31, 20)[1], expected + 4 * 255 / 219.0, 2);
  }
}

TEST(VideoFields, MakeOnePictureOfTwoPackets) {
  const test::TemporaryDirectory folder;
  for (const char* name : {"a.mp4", "a.mkv", "a.ts", "a.avi"}) {
    const std::filesystem::path file = folder.path() / name;
    test::write_field_video(file, kPictures, test::FieldPackets::timed);
    expect_pictures(file.string(), file.extension() != ".avi");
  }
}

TEST(VideoFields, MakeOnePictureWhereTheSecondHasNoTime) {
  const test::TemporaryDirectory folder;
  const std::filesystem::path file = folder.path() / "a.ts";
  test::write_field_video(file, kPictures, test::FieldPackets::untimed);
  expect_pictures(file.string(), true);
}

TEST(VideoFields, OfOnePacketAreOnePicture) {
  const test::TemporaryDirectory folder;
  for (const char* name : {"a.mp4", "a.mkv", "a.ts"}) {
    const std::filesystem::path file = folder.path() / name;
    test::write_field_video(file, kPictures, test::FieldPackets::joined);
    expect_pictures(file.string(), true);
  }
}

TEST(VideoFields, OfAStreamWithoutTimesAreCountedByItsRate) {
  const test::TemporaryDirectory folder;
  const std::filesystem::path file = folder.path() / "a.h264";
  test::write_field_video(file, kPictures, test::FieldPackets::timed);
  expect_pictures(file.string(), false);
}

}  // namespace
}  // namespace hypotrack
