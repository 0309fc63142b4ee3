#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <opencv2/videoio.hpp>
#include <string>

namespace hypotrack {

/// Reads a video file frame by frame.
class VideoReader {
 public:
  /// Throws DataError if the file is missing or no video, or if its first frame cannot be decoded.
  explicit VideoReader(const std::filesystem::path& file);

  int width() const { return width_; }
  int height() const { return height_; }
  /// Returns the file's frame rate in frames per second; 0 if unknown.
  double frame_rate() const { return frame_rate_; }
  /// Returns the file's number of frames; 0 if unknown.
  int frame_count() const { return frame_count_; }

  enum class Result { frame, damaged, end };
  /// Reads the next frame as 8-bit BGR. A frame that cannot be decoded is `damaged` while the file
  /// promises more. The last few frames may be missing without complaint, because containers often
  /// promise more than they hold.
  Result next(cv::Mat& frame);

  /// Returns a note for the user if the video ended well before the number of frames that its
  /// header says; empty otherwise.
  std::string problem_of_end() const;

 private:
  bool grab_and_retrieve(cv::Mat& frame);

  std::string name_;
  cv::VideoCapture capture_;
  cv::Mat first_;  ///< decoded by the constructor, not yet returned
  int width_ = 0;
  int height_ = 0;
  double frame_rate_ = 0;
  int frame_count_ = 0;
  int position_ = 0;
  int failures_ = 0;        ///< in a row
  int frames_at_end_ = -1;  ///< number of frames, once the end was met
};

}  // namespace hypotrack
