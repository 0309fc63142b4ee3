#include "camera/media/picture_converter.hpp"

extern "C" {
#include <libavutil/display.h>
#include <libavutil/pixdesc.h>
}

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

namespace hypotrack::internal {
namespace {

/// Returns the format without a range in its name, which `full` then tells.
AVPixelFormat without_range(AVPixelFormat format, bool& full) {
  const auto plain = [&](AVPixelFormat out) {
    full = true;
    return out;
  };
  switch (format) {
    case AV_PIX_FMT_YUVJ420P:
      return plain(AV_PIX_FMT_YUV420P);
    case AV_PIX_FMT_YUVJ411P:
      return plain(AV_PIX_FMT_YUV411P);
    case AV_PIX_FMT_YUVJ422P:
      return plain(AV_PIX_FMT_YUV422P);
    case AV_PIX_FMT_YUVJ444P:
      return plain(AV_PIX_FMT_YUV444P);
    case AV_PIX_FMT_YUVJ440P:
      return plain(AV_PIX_FMT_YUV440P);
    default:
      return format;
  }
}

const std::int32_t* display_matrix(const Demuxer& video, const AVFrame& first) {
  constexpr std::size_t kSize = 9 * sizeof(std::int32_t);
  const std::uint8_t* data = side_data_of(video.pictures(), AV_PKT_DATA_DISPLAYMATRIX, kSize);
  const AVFrameSideData* of_frame = av_frame_get_side_data(&first, AV_FRAME_DATA_DISPLAYMATRIX);
  if (!data && of_frame && of_frame->size >= kSize) data = of_frame->data;
  return reinterpret_cast<const std::int32_t*>(data);
}

}  // namespace

std::optional<Turn> turn_of(const std::int32_t* matrix) {
  // x' = a x + c y, y' = b x + d y, with y down
  const double a = matrix[0], b = matrix[1], c = matrix[3], d = matrix[4];
  const auto small = [](double x, double y, double than) {
    return std::max(std::abs(x), std::abs(y)) < 0.01 * std::abs(than);
  };
  if (small(b, c, a) && small(b, c, d)) {
    if (a > 0) return d > 0 ? Turn::none : Turn::flip;
    return d > 0 ? Turn::mirror : Turn::half;
  }
  if (small(a, d, b) && small(a, d, c)) {
    if (b > 0) return c > 0 ? Turn::transpose : Turn::clockwise;
    return c > 0 ? Turn::counterclockwise : Turn::antitranspose;
  }
  return std::nullopt;
}

cv::Mat turned(const cv::Mat& picture, Turn turn) {
  cv::Mat out;
  switch (turn) {
    case Turn::none:
      return picture.clone();
    case Turn::clockwise:
      cv::rotate(picture, out, cv::ROTATE_90_CLOCKWISE);
      return out;
    case Turn::half:
      cv::rotate(picture, out, cv::ROTATE_180);
      return out;
    case Turn::counterclockwise:
      cv::rotate(picture, out, cv::ROTATE_90_COUNTERCLOCKWISE);
      return out;
    case Turn::mirror:
      cv::flip(picture, out, 1);
      return out;
    case Turn::flip:
      cv::flip(picture, out, 0);
      return out;
    case Turn::transpose:
      cv::transpose(picture, out);
      return out;
    case Turn::antitranspose:
      cv::transpose(picture, out);
      cv::flip(out, out, -1);
      return out;
  }
  return out;
}

PictureConverter::PictureConverter(const Demuxer& video, const AVFrame& first,
                                   const VideoColors& colors, std::vector<std::string>& notes)
    : colors_(colors) {
  const std::int32_t* matrix = display_matrix(video, first);
  const std::optional<Turn> found = matrix ? turn_of(matrix) : Turn::none;
  turn_ = found.value_or(Turn::none);
  if (found && turn_ != Turn::none) notes.push_back(note_of_turn(turn_));
  if (!found) notes.push_back(note_of_slant(av_display_rotation_get(matrix)));
  add_color_notes(first, colors, notes);
  add_shape_notes(video, first, notes);
}

cv::Mat PictureConverter::convert(const AVFrame& frame) {
  constexpr int kRoom = 32;  // pixels
  bool full = frame.color_range == AVCOL_RANGE_JPEG;
  const AVPixelFormat format = without_range(static_cast<AVPixelFormat>(frame.format), full);
  if (colors_.range) full = *colors_.range == ColorRange::full;
  const int flags = SWS_BILINEAR | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT;
  scaler_.reset(sws_getCachedContext(scaler_.release(), frame.width, frame.height, format,
                                     frame.width, frame.height, AV_PIX_FMT_BGR24, flags, nullptr,
                                     nullptr, nullptr));
  if (!scaler_) return {};
  const int* coefficients = sws_getCoefficients(color_matrix_of(frame, colors_));
  sws_setColorspaceDetails(scaler_.get(), coefficients, full ? 1 : 0, coefficients, 1, 0, 1 << 16,
                           1 << 16);
  padded_.create(frame.height, (frame.width + 2 * kRoom - 1) / kRoom * kRoom, CV_8UC3);
  std::uint8_t* const rows[] = {padded_.data, nullptr, nullptr, nullptr};
  const int steps[] = {static_cast<int>(padded_.step), 0, 0, 0};
  if (sws_scale(scaler_.get(), frame.data, frame.linesize, 0, frame.height, rows, steps) <= 0)
    return {};
  return turned(padded_.colRange(0, frame.width), turn_);
}

}  // namespace hypotrack::internal
