// What picture files hold beside the pixels that are read, and formats that are not read.

#include <gmock/gmock.h>

#include <array>

#include "hypotrack/api/image_file.hpp"
#include "oriented_pictures.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using namespace std::string_literals;

const cv::Size kFewPixels(8, 6);

class PictureContents : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& bytes) const {
    test::write_bytes(folder_.path() / name, bytes);
    return folder_.path() / name;
  }
  std::string note(const std::string& name, const std::string& bytes) const {
    const std::array files{folder_.path() / "missing.png", write(name, bytes)};
    return contents_note(files);
  }
  std::string problem(const std::string& bytes) const {
    return read_color(write("a.png", bytes)).problem;
  }

  /// A chunk of a PNG file, without a valid checksum, behind the header.
  static std::string png_with(const std::string& name, const std::string& content) {
    std::string png = test::encoded(".png", cv::Mat::zeros(kFewPixels, CV_8UC3));
    return png.insert(33, test::bytes_of(static_cast<std::uint32_t>(content.size()), 4, true) +
                              name + content + "sums");
  }
  /// A segment of a JPEG file behind its first two bytes.
  static std::string jpeg_with(char marker, const std::string& content) {
    std::string jpeg = test::encoded(".jpg", cv::Mat::zeros(kFewPixels, CV_8UC3));
    return jpeg.insert(
        2, "\xFF"s + marker +
               test::bytes_of(static_cast<std::uint32_t>(content.size() + 2), 2, true) + content);
  }
  /// A TIFF file whose directories are kept, and follow each other.
  static std::string tiff_of(const std::vector<std::uint32_t>& subfile_types) {
    std::string out = "II*\0"s + test::bytes_of(8, 4);
    for (std::size_t i = 0; i < subfile_types.size(); ++i) {
      const bool last = i + 1 == subfile_types.size();
      const auto next = last ? 0 : static_cast<std::uint32_t>(out.size() + 2 + 12 + 4);
      out += test::bytes_of(1, 2) + test::bytes_of(254, 2) + test::bytes_of(4, 2) +
             test::bytes_of(1, 4) + test::bytes_of(subfile_types[i], 4) + test::bytes_of(next, 4);
    }
    return out;
  }
  /// An ICC profile of a name, as version 4 writes it.
  static std::string profile(const std::string& name) {
    const auto number = [](std::size_t value, int size = 4) {
      return test::bytes_of(static_cast<std::uint32_t>(value), size, true);
    };
    std::string wide;
    for (const char c : name) wide += "\0"s + c;
    const std::string text = "mluc"s + number(0) + number(1) + number(12) + "enUS" +
                             number(wide.size()) + number(28) + wide;
    return std::string(128, '\0') + number(1) + "desc" + number(144) + number(text.size()) + text;
  }
  /// The index of a JPEG file of several pictures of these types (CIPA DC-007, 5.2).
  static std::string multi_picture(const std::vector<std::uint32_t>& types) {
    std::string entries;
    for (const std::uint32_t type : types) entries += test::bytes_of(type, 4) + std::string(12, 0);
    const auto size = static_cast<std::uint32_t>(entries.size());
    return "MPF\0II*\0"s + test::bytes_of(8, 4) + test::bytes_of(1, 2) + test::bytes_of(0xB002, 2) +
           test::bytes_of(7, 2) + test::bytes_of(size, 4) + test::bytes_of(26, 4) +
           test::bytes_of(0, 4) + entries;
  }

  test::TemporaryDirectory folder_;
};

TEST_F(PictureContents, FurtherPicturesOfAFileAreCounted) {
  EXPECT_THAT(note("stack.tif", tiff_of({0, 0, 0})),
              AllOf(HasSubstr("stack.tif: holds 3 pictures, of which the first is read"),
                    HasSubstr("write each into a file of its own")));
  EXPECT_EQ(note("thumb.tif", tiff_of({0, 1})), "") << "a smaller copy is no picture";
  EXPECT_THAT(note("a.png", png_with("acTL", "\0\0\0\x04\0\0\0\0"s)),
              HasSubstr("holds 4 pictures"));
  EXPECT_THAT(note("pair.jpg", jpeg_with('\xE2', multi_picture({0x20020002, 0x00020002}))),
              HasSubstr("holds 2 pictures"));
  EXPECT_EQ(note("thumb.jpg", jpeg_with('\xE2', multi_picture({0x20030000, 0x00010001}))), "");
}

TEST_F(PictureContents, AChainOfDirectoriesThatDoesNotEndIsLeft) {
  std::string tiff = tiff_of({0, 0});
  tiff.replace(tiff.size() - 4, 4, test::bytes_of(8, 4));
  EXPECT_THAT(note("ring.tif", tiff), HasSubstr("pictures"));
  for (std::size_t size = 0; size < tiff.size(); ++size) note("cut.tif", tiff.substr(0, size));
  const std::string jpeg = multi_picture({0x20020002, 0x00020002});
  for (std::size_t size = 0; size < jpeg.size(); ++size)
    note("cut.jpg", jpeg_with('\xE2', jpeg.substr(0, size)));
  const std::string p3 = profile("Display P3");
  for (std::size_t size = 0; size < p3.size(); ++size)
    note("p.jpg", jpeg_with('\xE2', "ICC_PROFILE\0\1\1"s + p3.substr(0, size)));
}

TEST_F(PictureContents, ColourProfilesThatAreNotSrgbAreNamed) {
  EXPECT_THAT(note("p3.jpg", jpeg_with('\xE2', "ICC_PROFILE\0\1\1"s + profile("Display P3"))),
              AllOf(HasSubstr("p3.jpg: its colour profile 'Display P3' is not applied"),
                    HasSubstr("taken for sRGB")));
  EXPECT_THAT(note("a.png", png_with("iCCP", "Adobe RGB (1998)\0\0x"s)),
              HasSubstr("'Adobe RGB (1998)'"));
  EXPECT_THAT(note("linear.png", png_with("gAMA", test::bytes_of(100000, 4, true))),
              HasSubstr("its gamma of 1 is not applied"));
  for (const std::string& srgb :
       {png_with("iCCP", "sRGB IEC61966-2.1\0\0x"s), png_with("sRGB", "\0"s),
        png_with("gAMA", test::bytes_of(45455, 4, true)),
        jpeg_with('\xE2', "ICC_PROFILE\0\1\1"s + profile("sRGB IEC61966-2.1"))})
    EXPECT_EQ(note("srgb", srgb), "");
}

TEST_F(PictureContents, FormatsThatAreNotReadAreNamed) {
  EXPECT_THAT(
      problem("\0\0\0\x18"s + "ftypheic" + std::string(99, '\0')),
      EndsWith("a.png: is a picture in HEIF, which is not read; convert it to PNG or JPEG"));
  EXPECT_THAT(problem("\0\0\0\x0CJXL \x0D\x0A\x87\x0A"s), HasSubstr("in JPEG XL"));
  EXPECT_THAT(problem("v/1\x01"s + std::string(99, '\0')), HasSubstr("in OpenEXR"));
  EXPECT_THAT(problem("no picture at all"), EndsWith("a.png: is damaged or no image"));
  // OpenCV exchanges red and blue.
  EXPECT_THAT(problem("P7\nWIDTH 1\nHEIGHT 1\nDEPTH 3\nMAXVAL 255\nTUPLTYPE RGB\nENDHDR\nabc"),
              HasSubstr("in PAM, which is not read"));
}

TEST_F(PictureContents, PreviewsOfRawFilesAreNotTakenForPictures) {
  // OpenCV decodes the first picture of such TIFF files, a small copy.
  EXPECT_THAT(note("a.nef", tiff_of({1, 0})), HasSubstr("its first picture, which is read, is a "
                                                        "smaller copy of another"));
  std::string raw = test::tiff_with(1, cv::Mat::zeros(kFewPixels, CV_8U));
  EXPECT_EQ(problem(raw), "");
  raw.replace(raw.find(test::bytes_of(274, 2) + test::bytes_of(3, 2)), 2, test::bytes_of(50706, 2));
  EXPECT_THAT(problem(raw), HasSubstr("is a picture in DNG, which is not read"));
  for (std::size_t size = 0; size < 150; ++size) EXPECT_NE(problem(raw.substr(0, size)), "");
}

TEST_F(PictureContents, IntegersOf32BitsAreNotCalledFloatingPoint) {
  const auto type_of = [&](int type) {
    return read_color(write("a.tif", test::encoded(".tif", cv::Mat::ones(kFewPixels, type))))
        .problem;
  };
  EXPECT_THAT(type_of(CV_32S), HasSubstr("has 32-bit integer pixels; expected 8 or 16 bits"));
  EXPECT_THAT(type_of(CV_32F), HasSubstr("has floating-point pixels; expected 8 or 16 bits"));
}

TEST_F(PictureContents, TransparentPixelsOfMasksAreBackground) {
  cv::Mat mask(kFewPixels, CV_8UC4, cv::Scalar(255, 255, 255, 0));
  const auto foreground = [&] {
    return cv::countNonZero(read_mask(write("m.png", test::encoded(".png", mask))).image);
  };
  EXPECT_EQ(foreground(), kFewPixels.area()) << "alpha says nothing";
  mask.row(0).setTo(cv::Scalar(255, 255, 255, 9));
  mask.row(1).setTo(cv::Scalar(0, 0, 0, 255));
  EXPECT_EQ(foreground(), kFewPixels.width);
}

TEST_F(PictureContents, MasksOfJpegAreToldToBeInexact) {
  const cv::Mat black = cv::Mat::zeros(kFewPixels, CV_8U);
  const auto png = write("m.png", test::encoded(".png", black));
  const auto jpeg = write("m.jpg", test::encoded(".jpg", black));
  EXPECT_EQ(mask_note(std::array{png}), "");
  EXPECT_THAT(mask_note(std::array{folder_.path() / "missing.jpg", jpeg}),
              HasSubstr("m.jpg: is a JPEG file, whose black is inexact"));
}

TEST_F(PictureContents, NetpbmHasTheMaximumOfItsHeader) {
  const auto middle = [&](const std::string& bytes) {
    const ReadImage read = read_color(write("a.pnm", bytes));
    EXPECT_EQ(read.problem, "");
    EXPECT_EQ(read.image.size(), cv::Size(2, 1));
    return read.problem.empty() ? read.image.at<cv::Vec3b>(0, 1) : cv::Vec3b();
  };
  const cv::Vec3b grey(128, 128, 128);
  EXPECT_EQ(middle("P5\n2 1\n255\n\x00\x80"s), grey);
  EXPECT_EQ(middle("P5 # of a camera\n2 # wide\n1 51\n\x33\x1A"s), cv::Vec3b(130, 130, 130));
  EXPECT_EQ(middle("P2\n2 1\n51\n51 26\n"), cv::Vec3b(130, 130, 130)) << "text";
  EXPECT_EQ(middle("P5\n2 1\n1023\n\x03\xFF\x02\x02"s), grey);
  EXPECT_EQ(middle("P2\n2 1\n1023\n1023 514\n"), grey);
  EXPECT_EQ(middle("P5\n2 1\n65535\n\xFF\xFF\x80\x80"s), grey);
  EXPECT_EQ(middle("P6\n2 1\n51\n\x00\x00\x00\x33\x1A\x00"s), cv::Vec3b(0, 130, 255));
  EXPECT_EQ(bits_note(std::array{write("b.pgm", "P5\n2 1\n1023\n\x03\xFF\x02\x02"s)}, {}), "");
  EXPECT_THAT(problem("P5\n2 1\n255\n\x00"s), EndsWith("is cut off before its end"));
  EXPECT_THAT(problem("P5\n99999999 99999999\n255\n\x00"s), HasSubstr("at most 134217728"));
}

TEST_F(PictureContents, NetpbmHoldsDepthAsItIsStored) {
  const auto file = write("d.pgm", "P5\n2 1\n4095\n\x00\x00\x03\xE8"s);
  const ReadImage read = read_depth(file, 0.001);
  ASSERT_EQ(read.problem, "");
  EXPECT_EQ(read.image.at<float>(0, 1), 1.0f);
}

}  // namespace
}  // namespace hypotrack
