#include <gmock/gmock.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "mjpeg_server.hpp"
#include "oriented_pictures.hpp"
#include "source_fixture.hpp"

namespace hypotrack {
namespace {

using test::MjpegServer;
using testing::AllOf;
using testing::AnyOf;
using testing::ContainsRegex;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr int kPictures = 20;

/// Real streams of this machine. The blue of a picture tells its number, its green the view.
class Streams : public test::SourceFixture {
 protected:
  Streams() {
    for (int i = 0; i < kPictures; ++i) {
      const cv::Mat left = picture(i, 0), right = picture(i, 1);
      cv::Mat both;
      cv::hconcat(left, right, both);
      save("left", i, left);
      save("right", i, right);
      save("both", i, both);
    }
  }

  static cv::Mat picture(int number, int view, cv::Size size = {64, 48}) {
    return {size, CV_8UC3, cv::Scalar(20 + 10 * number, 60 + 100 * view, 40)};
  }
  void save(const std::string& name, int number, const cv::Mat& image) const {
    cv::imwrite(cv::format("%s_%02d.jpg", file(name).c_str(), number), image);
  }
  /// The number of a picture; -1 if it is none of this view. JPEG blends colours where two views
  /// meet, so the edges do not count.
  static int number_of(const cv::Mat& whole, int view) {
    const cv::Mat image = whole.colRange(8, whole.cols - 8);
    const cv::Scalar mean = cv::mean(image);
    const int number = cvRound((mean[0] - 20) / 10);
    const bool found = cv::norm(image, picture(number, view, image.size()), cv::NORM_INF) < 6;
    return found ? number : -1;
  }

  std::filesystem::path pictures(const std::string& name) const { return file(name + "_*.jpg"); }

  std::unique_ptr<Source> open(const std::string& lines) {
    return make("type: camera\ncalibration: {file: rig.yml}\n" + lines);
  }
  std::unique_ptr<Source> open(const MjpegServer& left, const MjpegServer& right,
                               const std::string& lines = "") {
    return open("left: \"" + left.url() + "\"\nright: \"" + right.url() + "\"\n" + lines);
  }
  std::unique_ptr<Source> open(const MjpegServer& both, const std::string& lines = "") {
    return open("device: \"" + both.url() + "\"\n" + lines);
  }
};

/// Checks that a frame is a pair of pictures of the rig.
void expect_pair(const Frame& frame) {
  ASSERT_EQ(frame.problem, "");
  ASSERT_EQ(frame.views.size(), 2u);
  for (const View& view : frame.views) {
    EXPECT_EQ(view.color.type(), CV_8UC3);
    EXPECT_EQ(view.color.size(), cv::Size(64, 48));
  }
}

TEST_F(Streams, PicturesComeWithoutACalibrationIfThatIsAskedFor) {
  const MjpegServer both(pictures("both"));
  const auto source = make("type: camera\nuncalibrated: true\ndevice: \"" + both.url() + "\"\n");
  EXPECT_EQ(source->cameras()[1].width, 64);
  EXPECT_EQ(source->cameras()[1].fx, 0);
  expect_pair(*source->next());
  EXPECT_THAT([&] { make("type: camera\ndevice: \"" + both.url() + "\"\n"); },
              ThrowsMessage<ConfigError>(HasSubstr("calibration")));
}

TEST_F(Streams, PicturesAreTurnedAsTheirExifDataSay) {
  constexpr int kByHalf = 3;
  for (int i = 0; i < kPictures; ++i) {
    cv::Mat half(48, 128, CV_8UC3, cv::Scalar::all(20));
    half.rowRange(0, 24).setTo(cv::Scalar::all(220));
    std::ofstream(cv::format("%s_%02d.jpg", file("turned").c_str(), i), std::ios::binary)
        << test::jpeg_with(test::exif(kByHalf), test::encoded(".jpg", half));
  }
  const MjpegServer turned(pictures("turned")), both(pictures("both"));
  const auto source = open(turned);
  const auto frame = source->next();
  ASSERT_TRUE(frame);
  expect_pair(*frame);
  EXPECT_LT(frame->views[0].color.at<cv::Vec3b>(4, 20)[0], 60);
  EXPECT_GT(frame->views[1].color.at<cv::Vec3b>(44, 20)[0], 180);
  EXPECT_THAT(source->notes(), testing::Contains(HasSubstr("turned as their Exif data say")));
  EXPECT_THAT(open(both)->notes(), testing::Not(testing::Contains(HasSubstr("Exif"))));
}

TEST_F(Streams, TwoDevicesGivePairsOfNewPictures) {
  const MjpegServer left(pictures("left"), {"--rate", "20", "--jitter", "0.01"});
  const MjpegServer right(pictures("right"), {"--rate", "20", "--jitter", "0.01"});
  const auto source = open(left, right);
  EXPECT_EQ(source->cameras().size(), 2u);
  EXPECT_GT(source->frame_rate(), 0);
  EXPECT_FALSE(source->frame_count());
  double time = -1;
  std::chrono::steady_clock::time_point begun;
  for (int i = 0; i < 12; ++i) {
    const auto frame = source->next();
    ASSERT_TRUE(frame);
    expect_pair(*frame);
    EXPECT_EQ(frame->index, i);
    EXPECT_GT(frame->time, time);
    time = frame->time;
    if (i == 0) begun = *frame->taken - std::chrono::nanoseconds(std::llround(1e9 * time));
    EXPECT_LE(frame->taken, std::chrono::steady_clock::now());
    const std::chrono::duration<double> since = *frame->taken - begun;
    EXPECT_NEAR(since.count(), time, 1e-6);
    EXPECT_GE(number_of(frame->views[0].color, 0), 0);
    EXPECT_GE(number_of(frame->views[1].color, 1), 0);
  }
  EXPECT_THAT(source->statistics(),
              ElementsAre(ContainsRegex("12 pairs at .* per second; offset of their pictures: "
                                        "median [0-9.]+ ms, largest [0-9.]+ ms, by their "
                                        "arrival: a stream does not say when it took them"),
                          ContainsRegex("left \\(http.*\\): [0-9]+ pictures, [0-9]+ dropped, 0 "
                                        "damaged, 0 reconnects"),
                          HasSubstr("right (http")));
}

TEST_F(Streams, TheFirstFrameIsAtTimeZero) {
  const MjpegServer both(pictures("both"));
  EXPECT_EQ(open(both)->next()->time, 0);
}

TEST_F(Streams, HalvesOfAPictureSideBySideAreExact) {
  const MjpegServer both(pictures("both"));
  const auto source = open(both);
  for (int i = 0; i < 5; ++i) {
    const auto frame = source->next();
    expect_pair(*frame);
    const int number = number_of(frame->views[0].color, 0);
    ASSERT_GE(number, 0);
    const cv::Mat sent = cv::imread(cv::format("%s_%02d.jpg", file("both").c_str(), number));
    EXPECT_EQ(cv::norm(frame->views[0].color, sent.colRange(0, 64), cv::NORM_INF), 0);
    EXPECT_EQ(cv::norm(frame->views[1].color, sent.colRange(64, 128), cv::NORM_INF), 0);
  }
  EXPECT_THAT(source->statistics()[0], testing::Not(HasSubstr("offset")));
}

TEST_F(Streams, PicturesThatNobodyTakesAreDroppedAndCounted) {
  const MjpegServer both(pictures("both"), {"--rate", "100"});
  const auto source = open(both);
  const auto first = source->next();
  // The queue holds eight pictures: waiting for more than twice that many drops some for sure.
  const auto pictures_of = [&] {
    const std::string line = source->statistics()[1];
    return std::stoi(line.substr(line.find("): ") + 3));
  };
  while (pictures_of() < 20) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  const auto second = source->next();
  expect_pair(*second);
  EXPECT_EQ(second->index, 1);
  EXPECT_THAT(source->statistics()[1], testing::Not(HasSubstr(" 0 dropped")));
  // Frames keep their pictures.
  EXPECT_GE(number_of(first->views[0].color, 0), 0);
}

TEST_F(Streams, AStreamThatStopsIsAMissingFrameAndComesBack) {
  const MjpegServer left(pictures("left"), {"--gone-file", file("gone").string()});
  const MjpegServer right(pictures("right"));
  const auto source = open(left, right, "timeout_s: 1\n");
  std::optional<Frame> frame = source->next();
  write("gone", "");
  while (frame->problem.empty()) frame = source->next();
  EXPECT_THAT(frame->problem,
              AllOf(HasSubstr("left (" + left.url() + ")"),
                    AnyOf(HasSubstr("the pictures stopped"), HasSubstr("cannot be opened"))));
  EXPECT_TRUE(frame->views.empty());
  const double missing = frame->time;
  std::filesystem::remove(file("gone"));
  while (!frame->problem.empty()) frame = source->next();
  expect_pair(*frame);
  EXPECT_GT(frame->time, missing);
  EXPECT_THAT(source->statistics()[1], ContainsRegex(" [1-9][0-9]* reconnects"));
}

TEST_F(Streams, AConnectionThatFallsSilentIsOpenedAgain) {
  const MjpegServer both(pictures("both"),
                         {"--stop", "hang", "--gone-file", file("gone").string()});
  const auto source = open(both, "timeout_s: 0.3\n");
  std::optional<Frame> frame = source->next();
  write("gone", "");
  while (frame->problem.empty()) frame = source->next();
  std::filesystem::remove(file("gone"));
  while (!frame->problem.empty()) frame = source->next();
  expect_pair(*frame);
}

TEST_F(Streams, ARunEndsWithAMessageAfterATimeWithoutPictures) {
  const MjpegServer both(pictures("both"), {"--stop-after", "30"});
  const auto source = open(both, "timeout_s: 0.2\ngive_up_s: 1\n");
  std::vector<std::string> problems;
  const auto read_all = [&] {
    while (const auto frame = source->next())
      if (!frame->problem.empty()) problems.push_back(frame->problem);
  };
  EXPECT_THAT(test::message_of<DataError>(read_all),
              AllOf(HasSubstr("source camera: no pair of pictures for 1 s"), HasSubstr(both.url()),
                    HasSubstr("give_up_s")));
  EXPECT_THAT(problems, testing::Not(testing::IsEmpty()));
}

TEST_F(Streams, ASourceEndsWhileItsDeviceHangs) {
  const MjpegServer both(pictures("both"), {"--stop-after", "30", "--stop", "hang"});
  auto source = open(both, "timeout_s: 3600\ngive_up_s: 0.5\n");
  EXPECT_THROW(while (source->next()){}, DataError);
  source.reset();  // its thread waits an hour for a picture
}

TEST_F(Streams, HalfAPictureIsDamagedAndTheNextOneTaken) {
  const MjpegServer both(pictures("both"), {"--cut", "3"});
  const auto source = open(both);
  for (int i = 0; i < 12; ++i) {
    const auto frame = source->next();
    expect_pair(*frame);
    EXPECT_GE(number_of(frame->views[0].color, 0), 0);
    EXPECT_GE(number_of(frame->views[1].color, 1), 0);
  }
  EXPECT_THAT(source->statistics()[1],
              AllOf(HasSubstr(" damaged"), testing::Not(HasSubstr(" 0 damaged"))));
}

TEST_F(Streams, PicturesThatAreNeverNearEachOtherMakeNoPair) {
  const MjpegServer left(pictures("left"));
  const MjpegServer right(pictures("right"));
  const auto source = open(left, right, "tolerance_ms: 0\ntimeout_s: 0.3\n");
  const auto frame = source->next();
  EXPECT_TRUE(frame->views.empty());
  EXPECT_THAT(frame->problem, ContainsRegex("the newest pictures of left and right are [0-9.]+ ms "
                                            "apart; a pair may be 0.0 \\(tolerance_ms\\)"));
}

TEST_F(Streams, PicturesHaveTheSizeOfTheCalibration) {
  calibrate(32, 48, 2);
  const MjpegServer both(pictures("both"));
  EXPECT_THAT([&] { open(both); },
              ThrowsMessage<DataError>(AllOf(HasSubstr("device (" + both.url() + ")"),
                                             HasSubstr("64x48"), HasSubstr("32x48"))));
}

TEST_F(Streams, OnePictureHasItsViewsOneAboveTheOtherWhereTheSceneSaysSo) {
  cv::Mat image(96, 64, CV_8UC3, cv::Scalar(20, 20, 20));
  image.rowRange(48, 96) = cv::Scalar(200, 200, 200);
  save("above", 0, image);
  const MjpegServer above(pictures("above"));
  const auto source = open(above, "layout: top_bottom\n");
  const auto before = std::chrono::system_clock::now().time_since_epoch();
  const auto frame = source->next();
  ASSERT_EQ(frame->views.size(), 2u) << frame->problem;
  EXPECT_NEAR(cv::mean(frame->views[0].color)[0], 20, 5);
  EXPECT_NEAR(cv::mean(frame->views[1].color)[0], 200, 5);
  ASSERT_TRUE(frame->stamp);  // of the wall clock
  EXPECT_NEAR(1e-9 * static_cast<double>(*frame->stamp),
              std::chrono::duration<double>(before).count(), 60);
}

TEST_F(Streams, AnOddWidthHasNoHalves) {
  save("odd", 0, cv::Mat(48, 63, CV_8UC3, cv::Scalar(1, 2, 3)));
  const MjpegServer odd(pictures("odd"));
  EXPECT_THAT([&] { open(odd); },
              ThrowsMessage<DataError>(HasSubstr("its picture is 63 pixels wide; expected an even "
                                                 "number")));
}

TEST_F(Streams, DevicesOfUnequalSizeNeedACalibrationThatSaysSo) {
  write("rig.yml",
        "%YAML:1.0\n---\nM1: [60, 0, 32, 0, 60, 24, 0, 0, 1]\nD1: [0, 0, 0, 0]\n"
        "M2: [60, 0, 32, 0, 60, 24, 0, 0, 1]\nD2: [0, 0, 0, 0]\n"
        "R: [1, 0, 0, 0, 1, 0, 0, 0, 1]\nT: [-0.1, 0, 0]\n");
  const MjpegServer left(pictures("left"));
  const MjpegServer right(pictures("both"));
  EXPECT_THAT([&] { open(left, right); },
              ThrowsMessage<DataError>(AllOf(HasSubstr("delivers 64x48 pixels"),
                                             HasSubstr("128x48; expected equal sizes"))));
}

TEST_F(Streams, TheFrameRateIsMeasuredUnlessItIsGiven) {
  const MjpegServer both(pictures("both"), {"--rate", "50"});
  EXPECT_EQ(open(both, "fps: 47\n")->frame_rate(), 47);
  EXPECT_NE(open(both)->frame_rate(), 47);
}

}  // namespace
}  // namespace hypotrack
