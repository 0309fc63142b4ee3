#include <gmock/gmock.h>

#include <array>

#include "hypotrack/api/calibration.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/image_file.hpp"
#include "oriented_pictures.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

using testing::AllOf;
using testing::ElementsAreArray;
using testing::HasSubstr;
using testing::Not;
using testing::ThrowsMessage;

const cv::Size kSize(48, 32);

/// The brightness of the quarters of a picture: upper left and right, lower left and right.
using Quarters = std::array<int, 4>;

cv::Mat quartered(int type = CV_8U) {
  cv::Mat image(kSize, type);
  image(cv::Rect(0, 0, 24, 16)) = 40;
  image(cv::Rect(24, 0, 24, 16)) = 100;
  image(cv::Rect(0, 16, 24, 16)) = 160;
  image(cv::Rect(24, 16, 24, 16)) = 220;
  return image;
}

Quarters quarters(const cv::Mat& image) {
  const auto at = [&](int row, int column) {
    const cv::Rect middle(image.cols * (1 + 2 * column) / 4 - 2, image.rows * (1 + 2 * row) / 4 - 2,
                          4, 4);
    return cvRound(cv::mean(image(middle))[0] / 10) * 10;  // JPEG is not exact
  };
  return {at(0, 0), at(0, 1), at(1, 0), at(1, 1)};
}

/// What viewers show for each orientation, from 1 on.
constexpr std::array<Quarters, 8> kShown = {{{40, 100, 160, 220},
                                             {100, 40, 220, 160},
                                             {220, 160, 100, 40},
                                             {160, 220, 40, 100},
                                             {40, 160, 100, 220},
                                             {160, 40, 220, 100},
                                             {220, 100, 160, 40},
                                             {100, 220, 40, 160}}};

class Orientation : public testing::Test {
 protected:
  std::filesystem::path file(const std::string& name) const { return folder_.path() / name; }
  std::filesystem::path write(const std::string& name, const std::string& bytes) const {
    test::write_bytes(file(name), bytes);
    return file(name);
  }
  static void expect_shown(const ReadImage& read, int orientation) {
    ASSERT_EQ(read.problem, "");
    const cv::Size turned(kSize.height, kSize.width);
    EXPECT_EQ(read.image.size(), orientation < 5 ? kSize : turned);
    EXPECT_THAT(quarters(read.image),
                ElementsAreArray(kShown[static_cast<std::size_t>(orientation - 1)]))
        << orientation;
  }
  std::string note(const std::vector<std::string>& names) const {
    std::vector<std::filesystem::path> files;
    for (const std::string& name : names) files.push_back(file(name));
    return orientation_note(files);
  }

  test::TemporaryDirectory folder_;
};

TEST_F(Orientation, OfEveryFormatIsHonouredAsViewersDo) {
  const cv::Mat image = quartered();
  const std::string jpeg = test::encoded(".jpg", image), png = test::encoded(".png", image);
  const std::string webp = test::encoded(".webp", image, {cv::IMWRITE_WEBP_QUALITY, 101});
  for (int o = 1; o <= 8; ++o) {
    expect_shown(read_color(write("a.jpg", test::jpeg_with(test::exif(o), jpeg))), o);
    expect_shown(read_color(write("b.jpg", test::jpeg_with(test::exif(o, true), jpeg))), o);
    expect_shown(read_color(write("a.png", test::png_with(test::exif(o), png))), o);
    expect_shown(read_color(write("a.webp", test::webp_with(test::exif(o), webp, kSize))), o);
    expect_shown(read_color(write("a.tif", test::tiff_with(o, image))), o);
  }
}

TEST_F(Orientation, TurnsMasksAndDepthToo) {
  const std::string depth = test::encoded(".png", quartered(CV_16U));
  for (int o = 1; o <= 8; ++o) {
    expect_shown(read_depth(write("d.png", test::png_with(test::exif(o), depth)), 1), o);
    expect_shown(read_depth(write("d.tif", test::tiff_with(o, quartered(CV_16U))), 1), o);
    cv::Mat half = cv::Mat::zeros(kSize, CV_8U);
    half.rowRange(0, 16) = 255;
    const cv::Mat mask =
        read_mask(write("m.png", test::png_with(test::exif(o), test::encoded(".png", half)))).image;
    EXPECT_EQ(cv::countNonZero(mask), 24 * 32);
    const Quarters shown = kShown[static_cast<std::size_t>(o - 1)];
    EXPECT_EQ(quarters(mask)[0] > 0, shown[0] <= 100) << o;
  }
}

TEST_F(Orientation, IsToldOnceWithWhatTheCalibrationMustBeOf) {
  const std::string png = test::encoded(".png", quartered());
  write("1.png", png);
  write("2.png", test::png_with(test::exif(1), png));
  EXPECT_EQ(note({"1.png", "2.png", "missing.png"}), "");
  write("6.png", test::png_with(test::exif(6), png));
  EXPECT_THAT(note({"missing.png", "6.png"}),
              AllOf(HasSubstr("6.png: its EXIF orientation is 6: it is turned by 90 degrees "
                              "clockwise, as viewers show it"),
                    HasSubstr("the calibration must be of pictures as viewers show them"),
                    Not(HasSubstr("Other pictures"))));
  for (const auto& names : {std::vector<std::string>{"1.png", "6.png"}, {"6.png", "1.png"}})
    EXPECT_THAT(note(names), HasSubstr("Other pictures of these have another orientation"));
}

TEST_F(Orientation, DamagedExifTurnsNothing) {
  const std::string jpeg = test::encoded(".jpg", quartered());
  const std::string whole = test::exif(6);
  for (std::size_t size = 0; size < whole.size() - 4; ++size)
    EXPECT_NO_THROW(
        read_color(write("cut.jpg", test::jpeg_with(whole.substr(0, size), jpeg))).image);
  expect_shown(read_color(write("9.jpg", test::jpeg_with(test::exif(9), jpeg))), 1);
  std::string far = whole;
  far.replace(4, 4, test::bytes_of(0xFFFFFFF0, 4));  // the directory's place
  expect_shown(read_color(write("far.jpg", test::jpeg_with(far, jpeg))), 1);
}

TEST_F(Orientation, ExplainsASizeThatIsTurned) {
  Camera camera;
  camera.width = 32;
  camera.height = 48;
  const cv::Mat image(48, 32, CV_8U), turned(32, 48, CV_8U), other(32, 47, CV_8U);
  EXPECT_EQ(size_problem("a.png", image, camera), "");
  EXPECT_THAT(size_problem("a.png", turned, camera),
              AllOf(HasSubstr("a.png: is 48x32 pixels; expected 32x48"),
                    HasSubstr("turned by 90 degrees it fits"),
                    HasSubstr("calibrate with pictures of 48x32")));
  EXPECT_THAT(size_problem("a.png", other, camera), Not(HasSubstr("turned")));
  EXPECT_THAT([&] { fit_image_size(camera, 48, 32, "a.png"); },
              ThrowsMessage<DataError>(HasSubstr("turned by 90 degrees it fits")));
}

class Bits : public Orientation {
 protected:
  /// Writes pictures whose brightest values are these, and returns the note on them.
  std::string note_of(const std::vector<int>& largest, std::optional<int> bits = {},
                      int type = CV_16U) {
    std::vector<std::filesystem::path> files;
    for (const int value : largest) {
      cv::Mat image = cv::Mat::ones(kSize, type);
      image.at<std::uint16_t>(3, 5) = static_cast<std::uint16_t>(value);
      files.push_back(write(cv::format("%zu.png", files.size()), test::encoded(".png", image)));
    }
    return bits_note(files, bits);
  }
};

TEST_F(Bits, FewerThanSixteenAreToldWithTheSettingToMake) {
  EXPECT_THAT(note_of({900, 1023}), AllOf(HasSubstr("0.png: no value of the first 2 pictures "
                                                    "exceeds 1023"),
                                          HasSubstr("set `bits: 10`, or `bits: 16`")));
  EXPECT_THAT(note_of({1024}), HasSubstr("`bits: 12`"));
  EXPECT_THAT(note_of({4095, 90}), AllOf(HasSubstr("16 times darker"), HasSubstr("`bits: 12`")));
  EXPECT_THAT(note_of({4096}), HasSubstr("`bits: 14`"));
  EXPECT_THAT(note_of({16383}), HasSubstr("`bits: 14`"));
  EXPECT_THAT(note_of({255}), HasSubstr("`bits: 8`"));
}

TEST_F(Bits, AreNotGuessedWhereValuesUseSixteenOrTheSettingFits) {
  EXPECT_EQ(note_of({16384}), "");
  EXPECT_EQ(note_of({4095 << 4}), "");  // shifted to the top
  EXPECT_EQ(note_of({4095}, 12), "");
  EXPECT_EQ(note_of({4095}, 16), "");
  EXPECT_EQ(note_of({100, 200, 65535}), "");
}

TEST_F(Bits, TooFewOrInVainAreTold) {
  EXPECT_THAT(note_of({4095}, 10), AllOf(HasSubstr("has values up to 4095"),
                                         HasSubstr("all above 1023 are white: set `bits: 12`")));
  const auto plain = write("plain.png", test::encoded(".png", quartered()));
  EXPECT_EQ(bits_note(std::array{plain}, std::nullopt), "");
  EXPECT_THAT(bits_note(std::array{plain}, 12), HasSubstr("plain.png: has 8 bits"));
}

TEST_F(Bits, OfAnAlphaChannelDoNotCount) {
  cv::Mat image(kSize, CV_16UC4, cv::Scalar(700, 800, 900, 65535));
  const auto alpha = write("alpha.png", test::encoded(".png", image));
  EXPECT_THAT(bits_note(std::array{alpha}, std::nullopt), HasSubstr("exceeds 900"));
}

}  // namespace
}  // namespace hypotrack
