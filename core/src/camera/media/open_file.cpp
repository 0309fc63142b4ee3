#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "camera/media/decoder.hpp"
#include "camera/media/library.hpp"
#include "camera/media/packet_times.hpp"
#include "camera/media/picture_converter.hpp"

namespace hypotrack::internal {
namespace {

constexpr double kUsualRate = 25;  // frames per second, what players take

double rate_of(const AVStream& stream) {
  for (const AVRational rate : {stream.avg_frame_rate, stream.r_frame_rate}) {
    const double value = rate.num > 0 && rate.den > 0 ? av_q2d(rate) : 0;
    if (value > 0 && value < 1e5) return value;
  }
  return 0;
}

class OpenedFile final : public VideoFile {
 public:
  OpenedFile(std::string name, PacketTimes packets, Decoder decoder)
      : packets_(std::move(packets)), decoder_(std::move(decoder)) {
    info_.name = std::move(name);
  }

  const VideoInfo& info() const override { return info_; }

  /// Decodes the first frame and takes from it what holds for all. Returns false if none can be
  /// decoded.
  bool begin(const VideoColors& colors) {
    if (!advance()) return false;
    first_ = *decoded_;
    const Demuxer& video = decoder_.video();
    std::vector<std::string> notes;
    if (first_ > 0)
      notes.push_back(fmt::format(
          "begins {} frames before the first that can be decoded; they are left out", first_));
    if (packets_.repeated > 0)
      notes.push_back(fmt::format(
          "its edit list shows {} frames twice, as FFmpeg does where the list asks for a pause: "
          "export it without edits",
          packets_.repeated));
    converter_.emplace(video, *frame_, colors, notes);
    info_.width = on_its_side(converter_->turn()) ? frame_->height : frame_->width;
    info_.height = on_its_side(converter_->turn()) ? frame_->width : frame_->height;
    for (const std::string& note : notes) info_.notes.push_back(info_.name + ": " + note);
    take_times(video.pictures());
    info_.has_clock = has_clock(video) && packets_.presented;
    if (!packets_.problem_of_end.empty())
      info_.problem_of_end = info_.name + ": " + packets_.problem_of_end;
    return true;
  }

  std::string read(std::size_t index, cv::Mat& picture) override {
    const std::size_t wanted = first_ + index;
    while (decoded_ && *decoded_ < wanted) advance();
    const auto problem = [&](const char* what) {
      return fmt::format("{}: the frame at {:.3f} s {}", info_.name,
                         info_.times[index] - info_.times[0], what);
    };
    if (decoded_ != wanted) return problem("cannot be decoded");
    if (packets_.shown[wanted].cut) return problem("is cut off: its data are not whole");
    if ((frame_->flags & AV_FRAME_FLAG_CORRUPT) != 0 || frame_->decode_error_flags != 0)
      return problem("is damaged: its data have errors");
    picture = converter_->convert(*frame_);
    return picture.empty() ? problem("has pixels in a format that is not supported") : "";
  }

 private:
  /// Goes to the next decoded frame that is shown. Returns false at the end.
  bool advance() {
    std::optional<std::size_t> found;
    while (!found && (frame_ = decoder_.next())) found = position(*frame_);
    decoded_ = found;
    return found.has_value();
  }

  /// Returns which of the shown frames a decoded one is; nothing if it has the time of an earlier
  /// one. Without times, frames that were not decoded count, too.
  std::optional<std::size_t> position(const AVFrame& frame) {
    const std::size_t next = decoded_ ? *decoded_ + 1 : 0;
    if (!packets_.presented) {
      const std::size_t before = std::exchange(failures_, decoder_.failures());
      return next + decoder_.failures() - before;
    }
    const std::int64_t time = frame.pts != AV_NOPTS_VALUE ? frame.pts : frame.best_effort_timestamp;
    const auto found = std::ranges::lower_bound(packets_.shown, time, {}, &ShownPicture::time);
    if (found == packets_.shown.end() || found->time != time) return next;
    const auto index = static_cast<std::size_t>(found - packets_.shown.begin());
    return index >= next ? std::optional(index) : std::nullopt;
  }

  void take_times(const AVStream& stream) {
    info_.frame_rate = packets_.numbered ? decoder_.stated_rate() : 0;
    if (info_.frame_rate == 0) info_.frame_rate = rate_of(stream);
    info_.tick = av_q2d(stream.time_base);
    const double rate = info_.frame_rate > 0 ? info_.frame_rate : kUsualRate;
    const bool raw = (decoder_.video().format->iformat->flags & AVFMT_NOTIMESTAMPS) != 0;
    if (raw && decoder_.stated_rate() == 0)
      info_.notes.push_back(
          fmt::format("{}: has neither times nor a rate; {:g} frames per second are assumed: give "
                      "frame_rate",
                      info_.name, rate));
    for (std::size_t i = first_; i < packets_.shown.size(); ++i) {
      const auto ticks = static_cast<double>(packets_.shown[i].time);
      info_.times.push_back(
          packets_.numbered ? ticks / rate : ticks * stream.time_base.num / stream.time_base.den);
    }
  }

  VideoInfo info_;
  PacketTimes packets_;
  Decoder decoder_;
  std::size_t first_ = 0;               ///< of the packets' pictures that is frame 0
  const AVFrame* frame_ = nullptr;      ///< current one of the decoder
  std::optional<std::size_t> decoded_;  ///< which of the packets' pictures it is
  std::size_t failures_ = 0;
  std::optional<PictureConverter> converter_;
};

/// Reads when the pictures of a file are shown. Returns what is wrong, or an empty text.
std::string scan(const std::string& file, PacketTimes& out) {
  Demuxer video;
  std::string problem = open_demuxer(file, video);
  if (problem.empty()) out = read_packet_times(video);
  return problem;
}

}  // namespace

std::unique_ptr<VideoFile> open_file(const std::string& file, const VideoColors& colors,
                                     std::string& problem) {
  PacketTimes packets;
  Demuxer video;
  problem = scan(file, packets);
  if (problem.empty()) problem = open_demuxer(file, video);
  if (!problem.empty()) return nullptr;
  Decoder decoder(std::move(video));
  problem = decoder.problem();
  if (!problem.empty()) return nullptr;
  auto out = std::make_unique<OpenedFile>(file, std::move(packets), std::move(decoder));
  if (out->begin(colors)) return out;
  problem = "its first frame cannot be decoded; the video is damaged or empty";
  return nullptr;
}

}  // namespace hypotrack::internal
