#include <gmock/gmock.h>

#include <opencv2/core.hpp>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/media.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// Videos that hypotrack writes.
class WrittenVideos : public testing::Test {
 protected:
  std::string file(const std::string& name) const { return (folder_.path() / name).string(); }

  /// Writes frames of one colour each, which gets brighter.
  static void write(const std::string& name, cv::Size size, double rate, int frames) {
    const auto video = create_video(name, size, rate);
    for (int i = 0; i < frames; ++i) EXPECT_EQ(video->write(cv::Mat(size, CV_8UC3, shade(i))), "");
    EXPECT_EQ(video->finish(), "");
  }
  static cv::Scalar shade(int frame) { return {200.0 - frame, 40, 60.0 + 8 * frame}; }

  test::TemporaryDirectory folder_;
};

TEST_F(WrittenVideos, HaveEveryFrameAtItsTimeInItsColour) {
  for (const double rate : {30.0, 25.0, 30000 / 1001.0, 7.5, 240.0, 0.01, 10000.0}) {
    write(file("a.mp4"), {160, 96}, rate, 17);
    const auto video = open_video(file("a.mp4"));
    ASSERT_THAT(video->info().times, SizeIs(17)) << rate;
    EXPECT_NEAR(video->info().frame_rate, rate, 1e-3 * rate);
    EXPECT_THAT(video->info().notes, IsEmpty());
    EXPECT_THAT(video->info().problem_of_end, IsEmpty());
    for (int i = 0; i < 17; ++i) {
      const auto index = static_cast<std::size_t>(i);
      EXPECT_NEAR(video->info().times[index] - video->info().times[0], i / rate, 1e-3);
      cv::Mat picture;
      ASSERT_EQ(video->read(index, picture), "");
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(picture.at<cv::Vec3b>(50, 80)[c], shade(i)[c], 4) << rate << ' ' << i;
    }
  }
}

TEST_F(WrittenVideos, OfOddSizesRepeatTheLastRowAndColumn) {
  write(file("a.mp4"), {161, 97}, 30, 3);
  const auto video = open_video(file("a.mp4"));
  EXPECT_EQ(video->info().width, 162);
  EXPECT_EQ(video->info().height, 98);
  cv::Mat picture;
  ASSERT_EQ(video->read(2, picture), "");
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(picture.at<cv::Vec3b>(97, 161)[c], shade(2)[c], 4);
}

TEST_F(WrittenVideos, MayHaveNamesThatLookLikeAddresses) {
  std::filesystem::create_directories(folder_.path() / "http:");
  write(file("http:/a:b.mp4"), {64, 48}, 30, 2);
  EXPECT_THAT(open_video(file("http:/a:b.mp4"))->info().times, SizeIs(2));
}

TEST_F(WrittenVideos, SayWhyTheyCannotBeCreated) {
  EXPECT_THAT(test::message_of<OutputError>([&] {
                create_video(file("missing/a.mp4"), {64, 48}, 30);
              }),
              AllOf(HasSubstr("missing/a.mp4"), HasSubstr("No such file or directory")));
}

TEST_F(WrittenVideos, SayThatTheDiskIsFull) {
  EXPECT_EQ(test::message_of<OutputError>([] {
              create_video("/dev/full", {640, 480}, 30);
            }),
            "/dev/full: No space left on device");
}

TEST_F(WrittenVideos, RefusePicturesOfAnotherSize) {
  const auto video = create_video(file("a.mp4"), {64, 48}, 30);
  EXPECT_THAT(video->write(cv::Mat(48, 66, CV_8UC3)), HasSubstr("66x48"));
  EXPECT_EQ(video->write(cv::Mat(48, 64, CV_8UC3, cv::Scalar())), "");
  EXPECT_EQ(video->finish(), "");
}

}  // namespace
}  // namespace hypotrack
