#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <opencv2/videoio.hpp>
#include <string>

namespace hypotrack {

/// A video file, frame by frame.
class VideoReader {
 public:
  /// Throws DataError if the file is missing or no video, or if its first frame cannot be decoded.
  explicit VideoReader(const std::filesystem::path& file);

  int width() const { return width_; }
  int height() const { return height_; }
  /// Frames per second as the file says; 0 if it does not.
  double frame_rate() const { return frame_rate_; }
  /// Number of frames as the file says; 0 if it does not.
  int frame_count() const { return frame_count_; }

  enum class Result { frame, damaged, end };
  /// The next frame as 8-bit BGR. A frame that cannot be decoded is `damaged` while the file says
  /// that more follow; the last few may be missing without complaint, because containers often
  /// promise more frames than they hold.
  Result next(cv::Mat& frame);

 private:
  bool grab_and_retrieve(cv::Mat& frame);

  std::string name_;
  cv::VideoCapture capture_;
  cv::Mat first_;  ///< decoded by the constructor, not yet given out
  int width_ = 0;
  int height_ = 0;
  double frame_rate_ = 0;
  int frame_count_ = 0;
  int position_ = 0;
  int failures_ = 0;  ///< in a row
};

}  // namespace hypotrack
