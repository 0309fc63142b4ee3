#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "hypotrack/export.hpp"

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

/// Reads the frames of a video file as cv::VideoCapture does, without turning them.
class HYPOTRACK_API VideoFile {
 public:
  VideoFile() = default;
  virtual ~VideoFile() = default;
  VideoFile(const VideoFile&) = delete;
  VideoFile& operator=(const VideoFile&) = delete;
  /// Goes to the next frame; false at the end.
  virtual bool grab() = 0;
  /// Decodes the current frame; false if that fails.
  virtual bool retrieve(cv::Mat& frame) = 0;
};

/// Opens a video file; returns null if it cannot be opened.
HYPOTRACK_API std::unique_ptr<VideoFile> open_video(const std::string& file);

}  // namespace hypotrack
