#include "camera/media/packet_times.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <string_view>
#include <utility>

namespace hypotrack::internal {
namespace {

constexpr std::size_t kMostPictures = 20'000'000;

/// Returns whether a packet is a VP8 frame that only others refer to (RFC 6386, section 9.1).
bool is_hidden(const AVPacket& packet, AVCodecID codec) {
  return codec == AV_CODEC_ID_VP8 && (packet.data[0] & 0x10) == 0;
}

/// Counts and times of the packets of pictures.
struct Read {
  std::size_t packets = 0;      ///< with data
  std::int64_t end = 0;         ///< of the last picture, in units of the stream
  std::int64_t last_start = 0;  ///< of decoding of the last one
  bool failed = false;          ///< before the end of the file
};

std::string_view container_of(const Demuxer& video) { return video.format->iformat->name; }

/// Returns whether an AVI file of one part is as long as its first bytes say.
bool is_whole_avi(const Demuxer& video) {
  constexpr std::int64_t kHead = 8, kNextPart = 12;  // bytes
  const std::int64_t size = avio_size(video.io.get());
  if (avio_seek(video.io.get(), kHead / 2, SEEK_SET) < 0) return false;
  const std::int64_t end = kHead + std::int64_t{avio_rl32(video.io.get())};
  return end <= size && size < end + kNextPart;
}

/// Returns the number of packets that the header promises; 0 if it does not say. The `nb_frames` of
/// MP4 count frames that its edit list leaves out. Those of AVI are ticks: a frame may take
/// several, and ticks without data repeat the frame before, at the end of a whole file, too.
std::size_t promised(const Demuxer& video, const Read& read) {
  const AVStream& stream = video.pictures();
  if (container_of(video) == "avi" && stream.nb_frames > 0 && read.packets > 0) {
    if (is_whole_avi(video)) return 0;
    const double ticks = static_cast<double>(read.last_start + 1);
    const double per_frame = std::max(1.0, std::round(ticks / static_cast<double>(read.packets)));
    const double left = static_cast<double>(stream.nb_frames) - (ticks - 1 + per_frame);
    return read.packets + static_cast<std::size_t>(std::max(0.0, left) / per_frame);
  }
  if (container_of(video).starts_with("mov"))
    return static_cast<std::size_t>(std::max(0, avformat_index_get_entries_count(&stream)));
  return 0;
}

std::string problem_of_end(const Demuxer& video, const Read& read, std::size_t shown) {
  constexpr std::size_t kUsual = 1;                             // frames too many in sound files
  const double least = video.format->nb_streams > 1 ? 2 : 0.2;  // seconds; sound may be longer
  constexpr const char* kAdvice = "the file may be cut off: copy or convert it again";
  const std::size_t expected = promised(video, read);
  if (read.packets > 0 && read.packets + kUsual < expected)
    return fmt::format("ends after {} frames, its header says {}; {}", shown,
                       expected - (read.packets - shown), kAdvice);
  if (read.failed) return fmt::format("cannot be read after {} frames; {}", shown, kAdvice);
  if (!container_of(video).starts_with("matroska") || video.format->duration <= 0) return {};
  const double end = static_cast<double>(read.end) * av_q2d(video.pictures().time_base);
  const double duration = static_cast<double>(video.format->duration) / AV_TIME_BASE;
  if (end + least > duration) return {};
  return fmt::format("ends at {:.3f} s, its header says {:.3f} s; {}", end, duration, kAdvice);
}

/// Puts pictures in the order of their times, and one where several have the same.
void order(std::vector<ShownPicture>& shown) {
  std::ranges::stable_sort(shown, {}, &ShownPicture::time);
  const auto same = std::ranges::unique(shown, {}, &ShownPicture::time);
  shown.erase(same.begin(), same.end());
}

bool is_timed(const ShownPicture& picture) { return picture.time != AV_NOPTS_VALUE; }

/// Leaves out pictures without a time between others: second fields, and those before a cut that
/// nothing can decode. The last ones follow the others.
void leave_out_untimed(std::vector<ShownPicture>& shown) {
  const auto last = std::ranges::find_if(shown.rbegin(), shown.rend(), is_timed).base();
  std::vector<ShownPicture> kept, after(last, shown.end());
  std::copy_if(shown.begin(), last, std::back_inserter(kept), is_timed);
  order(kept);
  const std::int64_t step = kept.size() > 1 ? kept.back().time - kept[kept.size() - 2].time : 1;
  for (ShownPicture picture : after) {
    picture.time = kept.back().time + step;
    kept.push_back(picture);
  }
  shown = std::move(kept);
}

/// Completes the times of MPEG-1 and MPEG-2, which files may give for some pictures only. In the
/// order of presentation, pictures have the times at which they or the next ones are decoded.
/// Returns false, and changes nothing, if the times do not fit.
bool complete_from_decoding(std::vector<ShownPicture>& shown, std::vector<std::int64_t> decoding,
                            AVCodecID codec) {
  if (codec != AV_CODEC_ID_MPEG1VIDEO && codec != AV_CODEC_ID_MPEG2VIDEO) return false;
  std::vector<std::int64_t> known, open;
  for (const ShownPicture& picture : shown)
    if (is_timed(picture)) known.push_back(picture.time);
  if (known.empty() || shown.size() < 2 || std::ranges::count(decoding, AV_NOPTS_VALUE) > 0)
    return false;
  std::ranges::sort(known);
  std::ranges::sort(decoding);
  if (known[0] != decoding[0]) {  // there are pictures that are shown before earlier ones
    decoding.push_back(2 * decoding.back() - decoding[decoding.size() - 2]);
    decoding.erase(decoding.begin());
  }
  std::ranges::set_difference(decoding, known, std::back_inserter(open));
  if (open.size() + known.size() != shown.size()) return false;
  auto next = open.begin();
  for (ShownPicture& picture : shown)
    if (!is_timed(picture)) picture.time = *next++;
  return true;
}

/// Gives the pictures times, where not all packets have one.
void complete_times(PacketTimes& out, const std::vector<std::int64_t>& decoding_times,
                    const Demuxer& video) {
  const auto timed = std::ranges::count_if(out.shown, is_timed);
  out.presented =
      timed == std::ssize(out.shown) ||
      complete_from_decoding(out.shown, decoding_times, video.pictures().codecpar->codec_id);
  if (!out.presented && has_clock(video) && 5 * timed > 2 * std::ssize(out.shown)) {
    leave_out_untimed(out.shown);
    out.presented = true;
  }
  if (out.presented) return;
  out.numbered = std::ranges::find(decoding_times, AV_NOPTS_VALUE) != decoding_times.end();
  for (std::size_t i = 0; i < out.shown.size(); ++i)
    out.shown[i].time = out.numbered ? static_cast<std::int64_t>(i) : decoding_times[i];
}

}  // namespace

bool has_clock(const Demuxer& video) {
  constexpr std::string_view kWithout[] = {"avi", "h264", "hevc",         "m4v",  "mpegvideo",
                                           "obu", "dv",   "yuv4mpegpipe", "mjpeg"};
  return std::ranges::find(kWithout, container_of(video)) == std::end(kWithout);
}

PacketTimes read_packet_times(Demuxer& video) {
  PacketTimes out;
  Read read;
  std::vector<std::int64_t> decoding_times;
  SecondFields second_fields(video);
  const bool edited = container_of(video).starts_with("mov");
  std::set<std::int64_t> places;  // of packets in the file
  const Ffmpeg<AVPacket> packet(av_packet_alloc());
  int result = 0;
  while (out.shown.size() < kMostPictures &&
         (result = av_read_frame(video.format.get(), packet.get())) >= 0) {
    const AVCodecID codec = video.pictures().codecpar->codec_id;
    const bool counts = packet->stream_index == video.stream && packet->size > 0;
    read.packets += counts ? 1 : 0;
    const bool second = counts && second_fields.take(*packet);
    if (second && !out.shown.empty() && (packet->flags & AV_PKT_FLAG_CORRUPT))
      out.shown.back().cut = true;
    if (counts && !second && !(packet->flags & AV_PKT_FLAG_DISCARD) && !is_hidden(*packet, codec)) {
      out.shown.push_back({packet->pts, (packet->flags & AV_PKT_FLAG_CORRUPT) != 0});
      decoding_times.push_back(packet->dts);
      out.repeated += edited && !places.insert(packet->pos).second ? 1 : 0;
      read.end = std::max(read.end, packet->pts + packet->duration);
      read.last_start = std::max(read.last_start, packet->dts);
    }
    av_packet_unref(packet.get());
  }
  read.failed = result < 0 && result != AVERROR_EOF;
  complete_times(out, decoding_times, video);
  order(out.shown);
  out.problem_of_end = problem_of_end(video, read, out.shown.size());
  return out;
}

}  // namespace hypotrack::internal
