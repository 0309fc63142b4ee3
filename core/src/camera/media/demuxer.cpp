extern "C" {
#include <libavutil/avstring.h>
#include <libavutil/dict.h>
}

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "camera/media/ffmpeg.hpp"

namespace hypotrack::internal {
namespace {

/// Containers that hold their pictures themselves. Playlists and lists of files are none.
constexpr const char* kContainers =
    "mov,mp4,matroska,webm,avi,mpegts,mpeg,mpegvideo,m4v,h264,hevc,obu,ivf,flv,asf,ogg,mjpeg,"
    "yuv4mpegpipe,nut,mxf,dv,gif,apng";

/// Returns what a file is that FFmpeg takes for something else than a container, and what to do.
std::string refused(const AVInputFormat& format) {
  const std::string_view name = format.name;
  if (name.ends_with("_pipe") || name == "image2")
    return "is a picture, not a video; expected pictures in the source `image_sequence`";
  return fmt::format(
      "cannot be opened as a video: its format is {} ({}), which may refer to other files or is no "
      "video; expected a file such as .mp4, .mov, .mkv, .webm, .avi or .ts",
      format.name, format.long_name ? format.long_name : format.name);
}

std::string not_opened() {
  return "cannot be opened as a video; is it damaged, or coded in a way that FFmpeg does not know?";
}

/// Returns whether the pictures are PNG. FFmpeg's parser of them looks for a picture's end and
/// joins a packet of a damaged one to the next.
bool is_png(const AVFormatContext& format) {
  return std::all_of(format.streams, format.streams + format.nb_streams, [](const AVStream* one) {
    const bool pictures = one->codecpar->codec_type == AVMEDIA_TYPE_VIDEO &&
                          !(one->disposition & AV_DISPOSITION_ATTACHED_PIC);
    return !pictures || one->codecpar->codec_id == AV_CODEC_ID_PNG;
  });
}

/// Lets FFmpeg look at the streams. Decoders see their first pictures here.
int find_streams(AVFormatContext& format) {
  if (format.nb_streams > 0 && is_png(format)) format.flags |= AVFMT_FLAG_NOPARSE;
  std::vector<AVDictionary*> options(format.nb_streams, nullptr);
  for (unsigned i = 0; i < format.nb_streams; ++i) {
    AVStream& stream = *format.streams[i];
    if (stream.codecpar->codec_type != AVMEDIA_TYPE_VIDEO) stream.discard = AVDISCARD_ALL;
    av_dict_set_int(&options[i], "max_pixels", kMostVideoPixels, 0);
  }
  const int result = avformat_find_stream_info(&format, options.data());
  for (AVDictionary*& one : options) av_dict_free(&one);
  return result;
}

/// Chooses the stream of pictures; a cover is none.
std::string choose_stream(Demuxer& out) {
  for (unsigned i = 0; i < out.format->nb_streams; ++i) {
    AVStream& stream = *out.format->streams[i];
    if (stream.disposition & AV_DISPOSITION_ATTACHED_PIC) stream.discard = AVDISCARD_ALL;
  }
  out.stream = av_find_best_stream(out.format.get(), AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
  if (out.stream < 0 || out.pictures().disposition & AV_DISPOSITION_ATTACHED_PIC)
    return "cannot be opened as a video: it has no pictures";
  const AVCodecParameters& coded = *out.pictures().codecpar;
  if (std::int64_t{coded.width} * coded.height > kMostVideoPixels)
    return fmt::format("has {}x{} pixels; at most {} are read", coded.width, coded.height,
                       kMostVideoPixels);
  return {};
}

}  // namespace

std::string open_demuxer(const std::string& file, Demuxer& out) {
  av_log_set_level(AV_LOG_QUIET);  // what is wrong is told by whoever reads
  AVIOContext* io = nullptr;
  if (avio_open2(&io, ("file:" + file).c_str(), AVIO_FLAG_READ, nullptr, nullptr) < 0)
    return "cannot be read; check its permissions";
  out.io.reset(io);
  if (std::string list = problem_of_playlist(*io, file); !list.empty()) return list;
  const AVInputFormat* container = nullptr;
  if (av_probe_input_buffer2(io, &container, file.c_str(), nullptr, 0, 0) < 0 || !container)
    return not_opened();
  if (av_match_list(container->name, kContainers, ',') <= 0) return refused(*container);
  AVFormatContext* format = avformat_alloc_context();
  if (!format) return "there is not enough memory to open it";
  format->pb = io;
  AVDictionary* options = nullptr;
  av_dict_set(&options, "protocol_whitelist", "none", 0);
  av_dict_set(&options, "format_whitelist", kContainers, 0);
  const int opened = avformat_open_input(&format, file.c_str(), container, &options);
  av_dict_free(&options);
  if (opened < 0) return not_opened();  // and `format` is freed
  out.format.reset(format);
  if (find_streams(*format) < 0) return not_opened();
  return choose_stream(out);
}

const std::uint8_t* side_data_of(const AVStream& stream, AVPacketSideDataType type,
                                 std::size_t least_size) {
#if LIBAVCODEC_VERSION_INT >= AV_VERSION_INT(60, 31, 100)
  const AVPacketSideData* found = av_packet_side_data_get(
      stream.codecpar->coded_side_data, stream.codecpar->nb_coded_side_data, type);
  return found && found->size >= least_size ? found->data : nullptr;
#else
  std::size_t size = 0;
  const std::uint8_t* data = av_stream_get_side_data(&stream, type, &size);
  return size >= least_size ? data : nullptr;
#endif
}

}  // namespace hypotrack::internal
