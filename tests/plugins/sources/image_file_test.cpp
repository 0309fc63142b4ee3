#include "hypotrack/api/image_file.hpp"

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "camera/pictures/orientation.hpp"
#include "hypotrack/api/media.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

/// Leaves this process so many bytes of address space beside what it has.
void leave_memory(rlim_t bytes) {
  rlim_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const rlim_t most = pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + bytes;
  const rlimit limit{most, most};
  setrlimit(RLIMIT_AS, &limit);
}

TEST(ImageFileDeathTest, LackOfMemoryIsNotCalledDamage) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers reserve the address space that this test limits";
#endif
  const test::TemporaryDirectory folder;
  const auto file = folder.path() / "large.png";
  ASSERT_TRUE(write_image(file.string(), cv::Mat::zeros(6000, 8000, CV_8U)));
  EXPECT_EQ(read_color(file).problem, "");
  const auto read_with_little = [&] {
    leave_memory(rlim_t{16} << 20);
    std::fputs(read_color(file).problem.c_str(), stderr);
    std::exit(0);
  };
  EXPECT_EXIT(read_with_little(), testing::ExitedWithCode(0),
              "large.png: there is not enough memory to decode it");
}

TEST(ImageFile, KeptImagesAreReadAnewWhereTheirFilesChange) {
  const test::TemporaryDirectory folder;
  const std::string file = (folder.path() / "grey.png").string();
  ASSERT_TRUE(write_image(file, cv::Mat(4, 6, CV_8U, cv::Scalar(7))));
  EXPECT_NE(read_color(file).image.data, read_color(file).image.data);
  internal::keep_read_images(1 << 20);
  const cv::Mat first = read_color(file).image;
  EXPECT_EQ(read_color(file).image.data, first.data);
  EXPECT_EQ(read_mask(file).image.type(), CV_8UC1);
  ASSERT_TRUE(write_image(file, cv::Mat(5, 6, CV_8U, cv::Scalar(9))));
  std::filesystem::last_write_time(
      file, std::filesystem::file_time_type::clock::now() + std::chrono::seconds(2));
  EXPECT_EQ(read_color(file).image.rows, 5);
  std::filesystem::remove(file);
  EXPECT_NE(read_color(file).problem, "");
  internal::keep_read_images(0);
}

TEST(ImageFile, HasThePixelsOfAJpegThatOpenCvDecodes) {
  cv::Mat3b picture(53, 37);
  cv::RNG(7).fill(picture, cv::RNG::UNIFORM, 0, 256);
  const std::vector<std::vector<int>> kinds = {{},
                                               {cv::IMWRITE_JPEG_QUALITY, 30},
                                               {cv::IMWRITE_JPEG_PROGRESSIVE, 1},
                                               {cv::IMWRITE_JPEG_OPTIMIZE, 1},
                                               {cv::IMWRITE_JPEG_RST_INTERVAL, 2}};
  for (const cv::Mat& image : {cv::Mat(picture), cv::Mat(picture.reshape(1))})
    for (const std::vector<int>& kind : kinds) {
      const std::vector<unsigned char> bytes = encode_image(".jpg", image, kind);
      const cv::Mat read = decode_image(cv::Mat(bytes, false).reshape(1, 1), cv::IMREAD_UNCHANGED);
      ASSERT_EQ(read.type(), image.type());
      const int color = image.channels() == 3 ? cv::IMREAD_COLOR : cv::IMREAD_GRAYSCALE;
      const cv::Mat expected = decode_image(cv::Mat(bytes, false).reshape(1, 1), color);
      EXPECT_EQ(cv::norm(read, expected, cv::NORM_INF), 0);
    }
}

/// Encodes a small picture and returns its bytes with another size in its header: 2 bytes for
/// height and width each at some place behind a mark.
std::string with_size(const char* format, std::string_view mark, std::size_t behind,
                      std::string_view height, std::string_view width) {
  const std::vector<unsigned char> bytes = encode_image(format, cv::Mat::zeros(8, 8, CV_8UC3));
  std::string text(bytes.begin(), bytes.end());
  const std::size_t at = text.find(mark) + mark.size() + behind;
  return text.replace(at, height.size() + width.size(), std::string(height) + std::string(width));
}

TEST(ImageFile, RefusesHugePicturesBeforeDecodingThem) {
  using namespace std::literals;
  const test::TemporaryDirectory folder;
  const auto problem_of = [&](const char* name, const std::string& bytes) {
    std::ofstream(folder.path() / name, std::ios::binary) << bytes;
    return read_color(folder.path() / name).problem;
  };
  // JPEG: 12,000 rows of 12,000. PNG, where the width comes first: 65,536 of 4,096.
  EXPECT_THAT(problem_of("a.jpg", with_size(".jpg", "\xFF\xC0", 3, "\x2E\xE0", "\x2E\xE0")),
              testing::EndsWith("a.jpg: has 12000x12000 pixels; at most 134217728 are read"));
  EXPECT_THAT(problem_of("a.png", with_size(".png", "IHDR", 0, "\0\1\0\0"sv, "\0\0\x10\0"sv)),
              testing::EndsWith("a.png: has 65536x4096 pixels; at most 134217728 are read"));
  EXPECT_EQ(problem_of("b.jpg", with_size(".jpg", "\xFF\xC0", 3, "\0\x08"sv, "\0\x08"sv)), "");
}

}  // namespace
}  // namespace hypotrack
