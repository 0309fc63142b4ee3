#include "reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <opencv2/imgproc.hpp>

#include "hypotrack/error.hpp"

namespace hypotrack {
namespace {

constexpr int kPatience = 30;  // undecodable frames in a row that end the video
constexpr int kPromised = 3;   // frames at the end that a container may promise and not hold

}  // namespace

VideoReader::VideoReader(const std::filesystem::path& file) : name_(file.string()) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    throw DataError(fmt::format("{}: no such file; expected a video", name_));
  }
  try {
    capture_.open(name_, cv::CAP_FFMPEG);
  } catch (const cv::Exception&) {
    capture_.release();
  }
  if (!capture_.isOpened()) {
    throw DataError(
        fmt::format("{}: cannot be opened as a video; is it damaged, or coded in a way "
                    "that OpenCV's FFmpeg does not know?",
                    name_));
  }
  // A calibration holds for the pixels as stored: do not rotate.
  capture_.set(cv::CAP_PROP_ORIENTATION_AUTO, 0);
  const double rate = capture_.get(cv::CAP_PROP_FPS);
  frame_rate_ = std::isfinite(rate) && rate > 0 && rate < 1e5 ? rate : 0;
  const double count = capture_.get(cv::CAP_PROP_FRAME_COUNT);
  frame_count_ = std::isfinite(count) && count > 0 && count < 1e9 ? static_cast<int>(count) : 0;
  if (!grab_and_retrieve(first_)) {
    throw DataError(
        fmt::format("{}: its first frame cannot be decoded; the video is damaged or "
                    "empty",
                    name_));
  }
  width_ = first_.cols;
  height_ = first_.rows;
}

bool VideoReader::grab_and_retrieve(cv::Mat& frame) {
  try {
    cv::Mat decoded;
    if (!capture_.read(decoded) || decoded.empty()) return false;
    if (decoded.channels() == 1) cv::cvtColor(decoded, decoded, cv::COLOR_GRAY2BGR);
    if (decoded.type() != CV_8UC3) return false;
    frame = decoded.clone();  // the decoder reuses its memory for the next frame
    return true;
  } catch (const cv::Exception& e) {
    if (e.code == cv::Error::StsNoMem) throw std::bad_alloc();
    return false;
  }
}

VideoReader::Result VideoReader::next(cv::Mat& frame) {
  if (position_ == 0 && !first_.empty()) {
    frame = std::move(first_);
    first_.release();
    ++position_;
    return Result::frame;
  }
  const bool read = failures_ <= kPatience && grab_and_retrieve(frame);
  ++position_;
  if (read) {
    failures_ = 0;
    return Result::frame;
  }
  ++failures_;
  const bool more_promised = position_ <= frame_count_ - kPromised;
  if (!more_promised && frames_at_end_ < 0) frames_at_end_ = position_ - failures_;
  return more_promised ? Result::damaged : Result::end;
}

std::string VideoReader::problem_of_end() const {
  constexpr int kUsual = 1;  // frames too many in sound files
  if (frames_at_end_ < 0 || frames_at_end_ + kUsual >= frame_count_) return {};
  return fmt::format(
      "{}: ends after {} frames, its header says {}; the file may be cut off: copy or convert it "
      "again",
      name_, frames_at_end_, frame_count_);
}

}  // namespace hypotrack
