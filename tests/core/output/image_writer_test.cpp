#include "output/recording/image_writer.hpp"

#include <gmock/gmock.h>

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "hypotrack/api/error.hpp"
#include "hypotrack/api/media.hpp"
#include "test_paths.hpp"

namespace hypotrack::test {
namespace {

cv::Mat random_image(int type, int seed) {
  cv::Mat image(60, 80, type);
  cv::RNG random(static_cast<std::uint64_t>(seed) + 1);
  random.fill(image, cv::RNG::UNIFORM, 0, image.depth() == CV_16U ? 65536 : 256);
  return image;
}

TEST(ImageWriter, WritesEveryImageAsItIs) {
  const TemporaryDirectory folder;
  const std::vector<int> types = {CV_8UC3, CV_8UC1, CV_16UC1};
  constexpr int kImages = 90;  // more than may wait
  const auto file = [&](int i) { return folder.path() / (std::to_string(i) + ".png"); };
  ImageWriter writer(2);
  for (int i = 0; i < kImages; ++i) writer.write(file(i), random_image(types[i % 3], i));
  writer.wait();
  for (int i = 0; i < kImages; ++i) {
    const cv::Mat read = read_image(file(i).string(), cv::IMREAD_UNCHANGED);
    const cv::Mat written = random_image(types[i % 3], i);
    ASSERT_EQ(read.type(), written.type()) << i;
    EXPECT_EQ(cv::norm(read, written, cv::NORM_INF), 0) << i;
  }
}

TEST(ImageWriter, ReportsTheImageThatCouldNotBeWrittenAndStops) {
  const TemporaryDirectory folder;
  ImageWriter writer(2);
  writer.write(folder.path() / "missing" / "a.png", random_image(CV_8UC3, 1));
  try {
    writer.wait();
    FAIL() << "no error";
  } catch (const OutputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("missing/a.png: the image cannot be written"));
  }
  EXPECT_THROW(writer.write(folder.path() / "b.png", random_image(CV_8UC3, 2)), OutputError);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "b.png"));
}

TEST(ImageWriter, LeavesNoHalfFileWhenItIsDropped) {
  const TemporaryDirectory folder;
  constexpr int kImages = 20;
  {
    ImageWriter writer(2);
    for (int i = 0; i < kImages; ++i) {
      writer.write(folder.path() / (std::to_string(i) + ".png"), random_image(CV_8UC3, i));
    }
  }
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    EXPECT_FALSE(read_image(entry.path().string()).empty()) << entry.path();
  }
}

}  // namespace
}  // namespace hypotrack::test
