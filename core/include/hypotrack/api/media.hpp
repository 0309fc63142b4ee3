#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hypotrack/api/export.hpp"

namespace hypotrack {

// Images and videos without linking against OpenCV's imgcodecs and videoio. These need two hundred
// further libraries, so a program that links against them starts slowly. Here the first call loads
// them; it throws DeviceError if that fails.

/// Reads an image file as cv::imread does: an empty image if it cannot be read.
HYPOTRACK_API cv::Mat read_image(const std::string& file, int flags = cv::IMREAD_COLOR);

/// Writes an image file as cv::imwrite does: false, or a cv::Exception, if it cannot be written.
HYPOTRACK_API bool write_image(const std::string& file, const cv::Mat& image,
                               const std::vector<int>& parameters = {});

/// Decodes a file's bytes (one row) as cv::imdecode does: an empty image if they are none.
HYPOTRACK_API cv::Mat decode_image(const cv::Mat& bytes, int flags);

/// Returns an image as a file's bytes, as cv::imencode makes them; `extension` is `.png` or the
/// like. Empty if it cannot be encoded.
HYPOTRACK_API std::vector<unsigned char> encode_image(const std::string& extension,
                                                      const cv::Mat& image,
                                                      const std::vector<int>& parameters = {});

/// Facts about a video file.
struct VideoInfo {
  std::string name;  ///< of the file
  int width = 0;     ///< of pictures as players show them
  int height = 0;
  double frame_rate = 0;  ///< frames per second that the file says; 0 if it does not
  /// When each frame is shown, in seconds on the file's own clock; they grow. Frames that an edit
  /// list leaves out, and those before the first that can be decoded, are not among them.
  std::vector<double> times;
  double tick = 0;         ///< resolution of `times`, seconds
  bool has_clock = false;  ///< times are of the frames themselves, not their number over a rate
  std::vector<std::string> notes;  ///< lines for the user: what is assumed or not honoured
  std::string problem_of_end;      ///< line for the user if data are missing at the end, or empty
};

/// Reads the frames of a local video file as players show them: turned as it asks, in its colours.
class HYPOTRACK_API VideoFile {
 public:
  VideoFile() = default;
  virtual ~VideoFile() = default;
  VideoFile(const VideoFile&) = delete;
  VideoFile& operator=(const VideoFile&) = delete;

  virtual const VideoInfo& info() const = 0;
  /// Decodes frame `index` of `info().times`, 8-bit BGR; indices of successive calls must grow.
  /// Returns an empty text, or why there is no picture: it names file and time.
  virtual std::string read(std::size_t index, cv::Mat& picture) = 0;
};

/// Matrix by which a video's brightness and colour differences become red, green and blue.
enum class ColorMatrix { bt601, bt709, bt2020 };
HYPOTRACK_API std::span<const std::string_view> enum_names(ColorMatrix);
/// Samples from black to white: 16 to 235 (limited) or 0 to 255 (full), of 8 bits.
enum class ColorRange { limited, full };
HYPOTRACK_API std::span<const std::string_view> enum_names(ColorRange);

/// Colours of a video whose file says nothing or something wrong.
struct VideoColors {
  std::optional<ColorMatrix> matrix{};  ///< empty: that of the file, or what players assume
  std::optional<ColorRange> range{};    ///< empty: that of the file, or limited
};

/// Opens a video file. Throws DataError if it is missing, no video, larger than images may be, or
/// if none of its frames can be decoded.
HYPOTRACK_API std::unique_ptr<VideoFile> open_video(const std::string& file,
                                                    const VideoColors& colors = {});

/// Writes pictures into a video file that players show: H.264 in MP4, or MPEG-4 where FFmpeg lacks
/// that. An object that is destroyed without finish() leaves a file that does not play.
class HYPOTRACK_API VideoWriter {
 public:
  VideoWriter() = default;
  virtual ~VideoWriter() = default;
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;

  /// Returns FFmpeg's name of the codec, `h264` or `mpeg4`.
  virtual std::string codec() const = 0;
  /// Adds a picture, 8-bit BGR of the video's size. Returns an empty text, or why it cannot be
  /// written.
  virtual std::string write(const cv::Mat& picture) = 0;
  /// Ends the file; write() must not follow. Returns an empty text, or why the file is not whole.
  virtual std::string finish() = 0;
};

/// Creates a video file (.mp4) of pictures of one size at a constant rate, in frames per second.
/// Odd widths and heights grow by a repeated pixel. Throws OutputError if it cannot be created.
HYPOTRACK_API std::unique_ptr<VideoWriter> create_video(const std::string& file, cv::Size size,
                                                        double frame_rate);

}  // namespace hypotrack
