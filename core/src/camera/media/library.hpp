#pragma once

#include "base/exported.hpp"
#include "hypotrack/api/media.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// The functions of media.hpp, in the module that links against OpenCV's libraries.
struct MediaLibrary {
  cv::Mat (*read)(const std::string& file, int flags);
  bool (*write)(const std::string& file, const cv::Mat& image, const std::vector<int>& parameters);
  cv::Mat (*decode)(const cv::Mat& bytes, int flags);
  std::vector<unsigned char> (*encode)(const std::string& extension, const cv::Mat& image,
                                       const std::vector<int>& parameters);
  /// Returns null, and why, if the file is no video.
  std::unique_ptr<VideoFile> (*open_video)(const std::string& file, const VideoColors& colors,
                                           std::string& problem);
  /// Returns null, and why, if the file cannot be created.
  std::unique_ptr<VideoWriter> (*create_video)(const std::string& file, cv::Size size,
                                               double frame_rate, std::string& problem);
};

/// Decodes a JPEG file of three channels to the pixels of cv::imdecode, in six tenths of its time:
/// OpenCV swaps the channels in a loop of its own. Returns an empty image for any other file and
/// for damaged ones.
cv::Mat decode_jpeg(const cv::Mat& bytes);

/// Opens a video file with FFmpeg. Returns null, and why in `problem`, if that fails.
std::unique_ptr<VideoFile> open_file(const std::string& file, const VideoColors& colors,
                                     std::string& problem);

/// Creates a video file with FFmpeg. Returns null, and why in `problem`, if that fails.
std::unique_ptr<VideoWriter> create_file(const std::string& file, cv::Size size, double frame_rate,
                                         std::string& problem);

/// Name of the module's function that returns its MediaLibrary.
inline constexpr const char* kMediaLibrary = "hypotrack_media_library";
using GetMediaLibrary = const MediaLibrary& (*)();

}  // namespace internal
}  // namespace hypotrack
