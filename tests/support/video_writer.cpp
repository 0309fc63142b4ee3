#include "video_writer.hpp"

extern "C" {
#include <libavformat/avformat.h>
#include <libavutil/dict.h>
#include <libavutil/pixdesc.h>
}

#include <algorithm>
#include <cstring>
#include <memory>
#include <stdexcept>

namespace hypotrack::test {
namespace {

int checked(int result, const char* what) {
  if (result < 0) throw std::runtime_error(std::string("cannot write a video: ") + what);
  return result;
}

struct Free {
  void operator()(AVFormatContext* format) const {
    avio_closep(&format->pb);
    avformat_free_context(format);
  }
  void operator()(AVCodecContext* codec) const { avcodec_free_context(&codec); }
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
};
template <class T>
using Owned = std::unique_ptr<T, Free>;

Owned<AVCodecContext> encoder_of(const VideoRecipe& recipe, const AVFormatContext& format) {
  const AVCodec* codec = avcodec_find_encoder_by_name(recipe.codec.c_str());
  if (!codec) throw std::runtime_error("there is no encoder " + recipe.codec);
  Owned<AVCodecContext> out(avcodec_alloc_context3(codec));
  out->width = recipe.width;
  out->height = recipe.height;
  out->pix_fmt = recipe.pixels;
  out->time_base = recipe.tick;
  out->colorspace = recipe.matrix;
  out->color_range = recipe.range;
  out->sample_aspect_ratio = recipe.aspect;
  out->flags |= AV_CODEC_FLAG_QSCALE;
  out->global_quality = FF_QP2LAMBDA;
  out->gop_size = 100;
  out->max_b_frames = recipe.reordered;
  out->thread_count = 1;
  if (format.oformat->flags & AVFMT_GLOBALHEADER) out->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  checked(avcodec_open2(out.get(), codec, nullptr), "the encoder does not open");
  return out;
}

void add_display(AVStream& stream, const std::array<std::int32_t, 9>& matrix) {
#if LIBAVCODEC_VERSION_INT >= AV_VERSION_INT(60, 31, 100)
  AVCodecParameters& coded = *stream.codecpar;
  std::uint8_t* data = av_packet_side_data_new(&coded.coded_side_data, &coded.nb_coded_side_data,
                                               AV_PKT_DATA_DISPLAYMATRIX, sizeof matrix, 0)
                           ->data;
#else
  std::uint8_t* data = av_stream_new_side_data(&stream, AV_PKT_DATA_DISPLAYMATRIX, sizeof matrix);
#endif
  std::memcpy(data, matrix.data(), sizeof matrix);
}

/// Returns how long the frame of a time is shown; the last one as long as the one before.
std::int64_t duration_of(const VideoRecipe& recipe, std::int64_t time) {
  const auto& times = recipe.times;
  const auto found = std::ranges::find(times, time);
  if (found == times.end() || times.size() < 2) return 1;
  return found + 1 == times.end() ? found[0] - found[-1] : found[1] - found[0];
}

void write_packets(const VideoRecipe& recipe, AVCodecContext& encoder, AVFormatContext& format,
                   const AVFrame* frame) {
  checked(avcodec_send_frame(&encoder, frame), "a frame is refused");
  const Owned<AVPacket> packet(av_packet_alloc());
  while (avcodec_receive_packet(&encoder, packet.get()) >= 0) {
    packet->duration = duration_of(recipe, packet->pts);
    if (recipe.damaged && packet->pts == recipe.times[*recipe.damaged]) {
      const int kept =
          encoder.codec_id == AV_CODEC_ID_H264 ? 4 : 0;  // where muxers look for a unit
      std::memset(packet->data + kept, 0xFF, static_cast<std::size_t>(packet->size - kept));
    }
    av_packet_rescale_ts(packet.get(), encoder.time_base, format.streams[0]->time_base);
    checked(av_write_frame(&format, packet.get()), "a packet is refused");
  }
}

void paint(const VideoRecipe& recipe, AVFrame& frame, int i) {
  if (recipe.paint) return recipe.paint(frame, i);
  for (int plane = 0; plane < 3; ++plane) fill_plane(frame, plane, plane == 0 ? 20 + 10 * i : 128);
}

}  // namespace

void fill_plane(AVFrame& frame, int plane, int value) {
  if (!frame.data[plane]) return;
  const auto* pixels = av_pix_fmt_desc_get(static_cast<AVPixelFormat>(frame.format));
  const int shift = plane == 1 || plane == 2 ? pixels->log2_chroma_h : 0;
  const int rows = (frame.height + (1 << shift) - 1) >> shift;
  std::memset(frame.data[plane], value,
              static_cast<std::size_t>(rows) * static_cast<std::size_t>(frame.linesize[plane]));
}

void write_video(const std::filesystem::path& file, const VideoRecipe& recipe) {
  AVFormatContext* made = nullptr;
  checked(avformat_alloc_output_context2(&made, nullptr, nullptr, file.c_str()), "no container");
  const Owned<AVFormatContext> format(made);
  const Owned<AVCodecContext> encoder = encoder_of(recipe, *format);
  AVStream& stream = *avformat_new_stream(format.get(), nullptr);
  stream.time_base = recipe.tick;
  stream.sample_aspect_ratio = recipe.aspect;
  avcodec_parameters_from_context(stream.codecpar, encoder.get());
  if (recipe.metadata[0]) av_dict_set(&stream.metadata, recipe.metadata[0], recipe.metadata[1], 0);
  if (recipe.display) add_display(stream, *recipe.display);
  format->avoid_negative_ts = AVFMT_AVOID_NEG_TS_DISABLED;
  checked(avio_open(&format->pb, file.c_str(), AVIO_FLAG_WRITE), "the file does not open");
  checked(avformat_write_header(format.get(), nullptr), "no header");
  const Owned<AVFrame> frame(av_frame_alloc());
  for (std::size_t i = 0; i < recipe.times.size(); ++i) {
    av_frame_unref(frame.get());
    frame->format = recipe.pixels;
    frame->width = recipe.width;
    frame->height = recipe.height;
    frame->sample_aspect_ratio = recipe.aspect;
    frame->colorspace = recipe.matrix;
    frame->color_range = recipe.range;
    frame->quality = FF_QP2LAMBDA;
    checked(av_frame_get_buffer(frame.get(), 0), "no memory");
    paint(recipe, *frame, static_cast<int>(i));
    frame->pts = recipe.times[i];
    write_packets(recipe, *encoder, *format, frame.get());
  }
  write_packets(recipe, *encoder, *format, nullptr);
  checked(av_write_trailer(format.get()), "no trailer");
}

}  // namespace hypotrack::test
