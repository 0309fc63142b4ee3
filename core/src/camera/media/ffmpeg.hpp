#pragma once

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/frame.h>
#include <libswscale/swscale.h>
}

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

// FFmpeg's objects with an owner.

struct FreeFfmpeg {
  void operator()(AVIOContext* io) const { avio_closep(&io); }
  void operator()(AVFormatContext* format) const { avformat_close_input(&format); }
  void operator()(AVCodecContext* codec) const { avcodec_free_context(&codec); }
  void operator()(AVCodecParserContext* parser) const { av_parser_close(parser); }
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
  void operator()(SwsContext* scaler) const { sws_freeContext(scaler); }
};
template <class T>
using Ffmpeg = std::unique_ptr<T, FreeFfmpeg>;

/// Largest number of pixels of a picture, as of image files: a few bytes must not take gigabytes.
inline constexpr std::int64_t kMostVideoPixels = std::int64_t{1} << 27;

/// A video file that is open for reading packets.
struct Demuxer {
  Ffmpeg<AVIOContext> io;  ///< outlives `format`
  Ffmpeg<AVFormatContext> format;
  int stream = -1;  ///< of the pictures

  const AVStream& pictures() const { return *format->streams[stream]; }
};

/// Opens a local file, and nothing that it refers to. Returns what is wrong, or an empty text.
std::string open_demuxer(const std::string& file, Demuxer& out);

/// Returns what a file is and what to do, if it is a list of other files; else an empty text.
std::string problem_of_playlist(AVIOContext& io, std::string_view name);

/// Returns side data of a stream; null if it has none of that type.
const std::uint8_t* side_data_of(const AVStream& stream, AVPacketSideDataType type,
                                 std::size_t least_size);

}  // namespace internal
}  // namespace hypotrack
