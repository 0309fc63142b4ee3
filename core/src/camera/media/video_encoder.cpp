extern "C" {
#include <libavutil/opt.h>
}

#include <fmt/format.h>

#include <array>
#include <opencv2/core.hpp>
#include <string>
#include <utility>

#include "camera/media/ffmpeg.hpp"
#include "camera/media/library.hpp"

namespace hypotrack::internal {
namespace {

/// An encoder of FFmpeg. Browsers play H.264, which not every FFmpeg can write, but not MPEG-4.
struct EncoderChoice {
  const char* name;
  const char* preset;  ///< null: it has none
};
// The default preset takes three times as long.
constexpr std::array<EncoderChoice, 3> kEncoders = {
    {{"libx264", "superfast"}, {"libopenh264", nullptr}, {"mpeg4", nullptr}}};

std::string text_of(int error) {
  std::array<char, AV_ERROR_MAX_STRING_SIZE> text{};
  av_strerror(error, text.data(), text.size());
  return text.data();
}

/// Returns an encoder that is open, or null.
Ffmpeg<AVCodecContext> open_encoder(const EncoderChoice& choice, cv::Size size, AVRational rate,
                                    bool global_header) {
  constexpr int kQuality = 3;  // quantiser of encoders that have no preset: hardly a loss
  const AVCodec* codec = avcodec_find_encoder_by_name(choice.name);
  if (!codec) return nullptr;
  Ffmpeg<AVCodecContext> out(avcodec_alloc_context3(codec));
  if (!out) return nullptr;
  out->width = size.width;
  out->height = size.height;
  out->pix_fmt = AV_PIX_FMT_YUV420P;
  out->time_base = av_inv_q(rate);
  out->framerate = rate;
  out->colorspace = AVCOL_SPC_BT709;
  out->color_primaries = AVCOL_PRI_BT709;
  out->color_trc = AVCOL_TRC_BT709;
  out->color_range = AVCOL_RANGE_MPEG;
  out->thread_count = 0;  // as many as there are cores
  if (global_header) out->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  if (choice.preset) {
    av_opt_set(out->priv_data, "preset", choice.preset, 0);
  } else {
    out->flags |= AV_CODEC_FLAG_QSCALE;
    out->global_quality = kQuality * FF_QP2LAMBDA;
  }
  if (avcodec_open2(out.get(), codec, nullptr) < 0) return nullptr;
  return out;
}

struct FreeMuxer {
  void operator()(AVFormatContext* format) const {
    avio_closep(&format->pb);
    avformat_free_context(format);
  }
};

class EncodedFile final : public VideoWriter {
 public:
  explicit EncodedFile(cv::Size size) : size_(size) {}

  /// Creates the file. Returns what is wrong, or an empty text.
  std::string begin(const std::string& file, double frame_rate) {
    constexpr int kLargest = 65535;  // of what MPEG-4 stores
    const AVRational rate = av_d2q(frame_rate, kLargest);
    const cv::Size even((size_.width + 1) / 2 * 2, (size_.height + 1) / 2 * 2);
    AVFormatContext* format = nullptr;
    avformat_alloc_output_context2(&format, nullptr, "mp4", nullptr);
    muxer_.reset(format);
    if (!muxer_ || !(rate.num > 0 && rate.den > 0)) return "FFmpeg cannot write .mp4 files";
    for (const EncoderChoice& choice : kEncoders)
      if (!codec_)
        codec_ = open_encoder(choice, even, rate, (format->oformat->flags & AVFMT_GLOBALHEADER));
    if (!codec_) return "this FFmpeg writes neither H.264 nor MPEG-4";
    return create(file, even);
  }

  std::string codec() const override { return avcodec_get_name(codec_->codec_id); }

  std::string write(const cv::Mat& picture) override {
    if (picture.type() != CV_8UC3 || picture.size() != size_)
      return fmt::format("a picture of {}x{} is no part of a video of {}x{}", picture.cols,
                         picture.rows, size_.width, size_.height);
    if (!failure_.empty()) return failure_;
    const int right = codec_->width - size_.width, below = codec_->height - size_.height;
    cv::copyMakeBorder(picture, even_, 0, below, 0, right, cv::BORDER_REPLICATE);
    if (const int error = av_frame_make_writable(frame_.get()); error < 0) return text_of(error);
    const std::uint8_t* const rows[] = {even_.data, nullptr, nullptr, nullptr};
    const int steps[] = {static_cast<int>(even_.step), 0, 0, 0};
    sws_scale(scaler_.get(), rows, steps, 0, even_.rows, frame_->data, frame_->linesize);
    frame_->pts = next_++;
    return encode(frame_.get());
  }

  std::string finish() override {
    if (!failure_.empty() || !muxer_) return failure_;
    std::string why = encode(nullptr);
    if (why.empty()) why = text_unless_good(av_write_trailer(muxer_.get()));
    const int error = muxer_->pb->error;
    const int closing = avio_closep(&muxer_->pb);
    muxer_.reset();
    if (why.empty()) why = text_unless_good(error);
    return why.empty() ? text_unless_good(closing) : why;
  }

 private:
  static std::string text_unless_good(int result) { return result < 0 ? text_of(result) : ""; }

  std::string create(const std::string& file, cv::Size even) {
    stream_ = avformat_new_stream(muxer_.get(), nullptr);
    packet_.reset(av_packet_alloc());
    frame_.reset(av_frame_alloc());
    scaler_.reset(sws_getContext(even.width, even.height, AV_PIX_FMT_BGR24, even.width, even.height,
                                 AV_PIX_FMT_YUV420P, SWS_BILINEAR, nullptr, nullptr, nullptr));
    if (!stream_ || !packet_ || !frame_ || !scaler_) return text_of(AVERROR(ENOMEM));
    const int* coefficients = sws_getCoefficients(SWS_CS_ITU709);
    sws_setColorspaceDetails(scaler_.get(), coefficients, 1, coefficients, 0, 0, 1 << 16, 1 << 16);
    frame_->format = codec_->pix_fmt;
    frame_->width = even.width;
    frame_->height = even.height;
    int error = av_frame_get_buffer(frame_.get(), 0);
    if (error >= 0) error = avcodec_parameters_from_context(stream_->codecpar, codec_.get());
    stream_->time_base = codec_->time_base;
    stream_->avg_frame_rate = codec_->framerate;
    // A plain path may look like an address: `a:b.mp4`.
    if (error >= 0) error = avio_open(&muxer_->pb, ("file:" + file).c_str(), AVIO_FLAG_WRITE);
    if (error >= 0) error = avformat_write_header(muxer_.get(), nullptr);
    return text_unless_good(error);
  }

  /// Encodes a frame (null: the end) and writes what is ready. Returns what is wrong, once and for
  /// all later calls, or an empty text.
  std::string encode(const AVFrame* frame) {
    int error = avcodec_send_frame(codec_.get(), frame);
    while (error >= 0) {
      error = avcodec_receive_packet(codec_.get(), packet_.get());
      if (error == AVERROR(EAGAIN) || error == AVERROR_EOF) return {};
      if (error < 0) break;
      packet_->duration = 1;
      packet_->stream_index = stream_->index;
      av_packet_rescale_ts(packet_.get(), codec_->time_base, stream_->time_base);
      error = av_interleaved_write_frame(muxer_.get(), packet_.get());
      if (error >= 0) error = muxer_->pb->error;
    }
    return failure_ = text_of(error);
  }

  cv::Size size_;
  cv::Mat even_;  ///< the picture with even width and height, as 4:2:0 needs
  std::unique_ptr<AVFormatContext, FreeMuxer> muxer_;  ///< null after the end
  Ffmpeg<AVCodecContext> codec_;
  AVStream* stream_ = nullptr;
  Ffmpeg<AVPacket> packet_;
  Ffmpeg<AVFrame> frame_;
  Ffmpeg<SwsContext> scaler_;
  std::int64_t next_ = 0;  ///< number of the next frame
  std::string failure_;
};

}  // namespace

std::unique_ptr<VideoWriter> create_file(const std::string& file, cv::Size size, double frame_rate,
                                         std::string& problem) {
  av_log_set_level(AV_LOG_QUIET);  // what is wrong is told by whoever writes
  auto out = std::make_unique<EncodedFile>(size);
  problem = out->begin(file, frame_rate);
  return problem.empty() ? std::move(out) : nullptr;
}

}  // namespace hypotrack::internal
