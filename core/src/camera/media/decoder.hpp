#pragma once

#include "camera/media/ffmpeg.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Decodes the pictures of a file from its beginning, in the order of their presentation.
class Decoder {
 public:
  /// Check `problem()`: empty if decoding can begin.
  explicit Decoder(Demuxer video);
  const std::string& problem() const { return problem_; }
  const Demuxer& video() const { return video_; }
  /// Returns the next picture, valid until the next call; null at the end.
  const AVFrame* next();
  /// Returns the frames per second that the coded pictures say; 0 if they do not.
  double stated_rate() const;
  /// Returns the number of packets so far that could not be decoded.
  std::size_t failures() const { return failures_; }

 private:
  /// Gives the decoder another packet, or tells it of the end. Throws std::bad_alloc.
  void feed();

  Demuxer video_;
  Ffmpeg<AVCodecContext> codec_;
  Ffmpeg<AVPacket> packet_;
  Ffmpeg<AVFrame> frame_;
  std::size_t failures_ = 0;
  bool ended_ = false;  ///< there are no further packets
  std::string problem_;
};

}  // namespace internal
}  // namespace hypotrack
