#include "camera/media/decoder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <thread>
#include <utility>

namespace hypotrack::internal {
namespace {

constexpr unsigned kMostThreads = 8;  // each holds pictures

}  // namespace

Decoder::Decoder(Demuxer video)
    : video_(std::move(video)), packet_(av_packet_alloc()), frame_(av_frame_alloc()) {
  const AVCodecParameters& coded = *video_.pictures().codecpar;
  const AVCodec* codec = avcodec_find_decoder(coded.codec_id);
  if (!codec) {
    problem_ = fmt::format(
        "cannot be opened as a video: it is coded as {}, which this FFmpeg does not decode",
        avcodec_get_name(coded.codec_id));
    return;
  }
  codec_.reset(avcodec_alloc_context3(codec));
  if (!codec_ || !packet_ || !frame_) throw std::bad_alloc();
  avcodec_parameters_to_context(codec_.get(), &coded);
  codec_->pkt_timebase = video_.pictures().time_base;
  codec_->max_pixels = kMostVideoPixels;
  // Of these FFmpeg does not say which pictures it completes after errors.
  if (coded.codec_id == AV_CODEC_ID_MJPEG) codec_->err_recognition |= AV_EF_EXPLODE;
  codec_->thread_count =
      static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1U, kMostThreads));
  if (avcodec_open2(codec_.get(), codec, nullptr) < 0)
    problem_ = fmt::format("cannot be opened as a video: its {} cannot be decoded", codec->name);
}

void Decoder::feed() {
  int result = 0;
  while ((result = av_read_frame(video_.format.get(), packet_.get())) >= 0) {
    if (packet_->stream_index == video_.stream && packet_->size > 0) break;
    av_packet_unref(packet_.get());
  }
  const bool end = result < 0;
  result = avcodec_send_packet(codec_.get(), end ? nullptr : packet_.get());
  av_packet_unref(packet_.get());
  if (result == AVERROR(ENOMEM)) throw std::bad_alloc();
  if (result < 0 && !end) ++failures_;
  ended_ = end;
}

const AVFrame* Decoder::next() {
  for (unsigned after_end = 0;; after_end += ended_ ? 1 : 0) {
    const int result = avcodec_receive_frame(codec_.get(), frame_.get());
    if (result >= 0) return frame_.get();
    if (result == AVERROR_EOF || (ended_ && after_end > kMostThreads)) return nullptr;
    if (result == AVERROR(ENOMEM)) throw std::bad_alloc();
    if (result == AVERROR(EAGAIN))
      feed();
    else
      ++failures_;
  }
}

double Decoder::stated_rate() const {
  const AVRational rate = codec_->framerate;
  return rate.num > 0 && rate.den > 0 ? av_q2d(rate) : 0;
}

}  // namespace hypotrack::internal
