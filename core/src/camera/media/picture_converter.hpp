#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "camera/media/ffmpeg.hpp"
#include "hypotrack/api/media.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Right angles and mirrors that lead from stored to shown pictures.
enum class Turn { none, clockwise, half, counterclockwise, mirror, flip, transpose, antitranspose };

/// Returns the turn of a display matrix; nothing if it is none of these.
std::optional<Turn> turn_of(const std::int32_t* matrix);
/// Returns a turned copy.
cv::Mat turned(const cv::Mat& picture, Turn turn);
/// Returns whether width and height change places.
inline bool on_its_side(Turn turn) {
  return turn == Turn::clockwise || turn == Turn::counterclockwise || turn == Turn::transpose ||
         turn == Turn::antitranspose;
}

/// Converts decoded pictures to 8-bit BGR as players show them: by their colour matrix, range and
/// display matrix. Pixels that are not square stay as stored.
class PictureConverter {
 public:
  /// Looks at the stream and its first picture. Adds lines for the user on what it assumes and on
  /// what it does not honour.
  PictureConverter(const Demuxer& video, const AVFrame& first, const VideoColors& colors,
                   std::vector<std::string>& notes);
  /// Returns an empty picture if the format of the pixels is not supported.
  cv::Mat convert(const AVFrame& frame);
  Turn turn() const { return turn_; }

 private:
  Turn turn_ = Turn::none;
  VideoColors colors_;
  Ffmpeg<SwsContext> scaler_;
  cv::Mat padded_;  ///< rows have room for what SIMD writes beyond their end
};

// Lines for the user on what is assumed about a video's pictures, and what is not honoured.

/// Returns the matrix of a picture's colours, of SWS_CS_: the one that is given, what the picture
/// says, or what players assume.
int color_matrix_of(const AVFrame& frame, const VideoColors& colors);

std::string note_of_turn(Turn turn);
/// `degrees` is counterclockwise; NaN if the display matrix is singular.
std::string note_of_slant(double degrees);
void add_color_notes(const AVFrame& frame, const VideoColors& colors,
                     std::vector<std::string>& notes);
void add_shape_notes(const Demuxer& video, const AVFrame& frame, std::vector<std::string>& notes);

}  // namespace internal
}  // namespace hypotrack
