#include "camera/media/picture_converter.hpp"

extern "C" {
#include <libavutil/dict.h>
#include <libavutil/pixdesc.h>
#include <libavutil/stereo3d.h>
}

#include <fmt/format.h>

#include <string_view>
#include <utility>

namespace hypotrack::internal {
namespace {

/// Returns whether players take the colours of untagged pictures for those of HD.
bool is_hd(const AVFrame& frame) { return frame.width >= 1280 || frame.height > 576; }

bool is_interlaced(const AVFrame& frame) {
#if LIBAVUTIL_VERSION_INT >= AV_VERSION_INT(58, 7, 100)
  return (frame.flags & AV_FRAME_FLAG_INTERLACED) != 0;
#else
  return frame.interlaced_frame != 0;
#endif
}

/// Returns the note that a file says how its pictures hold both views; empty if it does not.
std::string note_of_stereo(const AVStream& stream) {
  const std::uint8_t* data = side_data_of(stream, AV_PKT_DATA_STEREO3D, 2 * sizeof(int));
  if (!data) return {};
  switch (reinterpret_cast<const AVStereo3D*>(data)->type) {
    case AV_STEREO3D_SIDEBYSIDE:
      return "says that it holds both views side by side";
    case AV_STEREO3D_TOPBOTTOM:
      return "says that it holds both views one above the other";
    case AV_STEREO3D_2D:
      return {};
    default:
      return "says that it holds both views in a way that is not supported; expected them side by "
             "side or one above the other";
  }
}

int number_of(ColorMatrix matrix) {
  switch (matrix) {
    case ColorMatrix::bt601:
      return SWS_CS_ITU601;
    case ColorMatrix::bt709:
      return SWS_CS_ITU709;
    case ColorMatrix::bt2020:
      return SWS_CS_BT2020;
  }
  return SWS_CS_DEFAULT;
}

const char* name_of(ColorMatrix matrix) {
  if (matrix == ColorMatrix::bt601) return "BT.601";
  return matrix == ColorMatrix::bt709 ? "BT.709" : "BT.2020";
}

/// Returns what is assumed of the colour matrix, or not honoured; empty if nothing is.
std::string note_of_matrix(const AVFrame& frame, const VideoColors& colors, bool yuv) {
  if (!yuv)
    return colors.matrix ? "has pixels of RGB or grey, which have no matrix; color_matrix "
                           "changes nothing"
                         : "";
  const char* name = av_color_space_name(frame.colorspace);
  const bool unsaid = frame.colorspace == AVCOL_SPC_UNSPECIFIED;
  const char* taken = is_hd(frame) ? "BT.709" : "BT.601";
  if (colors.matrix && (unsaid || color_matrix_of(frame, colors) == color_matrix_of(frame, {})))
    return {};
  if (colors.matrix)
    return fmt::format("has colours in {}; they are taken for {} as color_matrix says",
                       name ? name : "an unknown matrix", name_of(*colors.matrix));
  if (unsaid)
    return fmt::format(
        "does not say its colour matrix; {} is assumed, as players do for {}; if colours are "
        "wrong, give color_matrix",
        taken, is_hd(frame) ? "HD" : "SD");
  if (frame.colorspace == AVCOL_SPC_BT2020_CL)
    return "has colours of constant luminance, which are read as BT.2020 without it";
  if (color_matrix_of(frame, {}) != frame.colorspace)
    return fmt::format("has colours in {}, which is not supported; {} is assumed",
                       name ? name : "an unknown matrix", taken);
  return {};
}

/// Returns that the range given is not that of the file, or not used; empty if there is nothing.
std::string note_of_range(const AVFrame& frame, const VideoColors& colors, bool yuv) {
  if (!colors.range) return {};
  if (!yuv) return "has pixels of RGB or grey, whose range is full; color_range changes nothing";
  const bool full = *colors.range == ColorRange::full;
  if (frame.color_range == (full ? AVCOL_RANGE_MPEG : AVCOL_RANGE_JPEG))
    return fmt::format("has samples of the {} range; they are taken for {} as color_range says",
                       full ? "limited" : "full", full ? "full" : "limited");
  return {};
}

constexpr const char* kNoteOfAlpha = "has transparency, which is dropped";

/// Returns whether a WebM file holds transparency beside the pictures, as VP8 and VP9 do.
bool has_alpha_beside(const AVStream& stream) {
  const AVDictionaryEntry* mode = av_dict_get(stream.metadata, "alpha_mode", nullptr, 0);
  return mode && std::string_view(mode->value) != "0";
}

}  // namespace

int color_matrix_of(const AVFrame& frame, const VideoColors& colors) {
  if (colors.matrix) return number_of(*colors.matrix);
  switch (frame.colorspace) {
    case AVCOL_SPC_BT709:
    case AVCOL_SPC_FCC:
    case AVCOL_SPC_BT470BG:
    case AVCOL_SPC_SMPTE170M:
    case AVCOL_SPC_SMPTE240M:
      return frame.colorspace;  // which have the same numbers
    case AVCOL_SPC_BT2020_NCL:
    case AVCOL_SPC_BT2020_CL:
      return SWS_CS_BT2020;
    default:
      return is_hd(frame) ? SWS_CS_ITU709 : SWS_CS_ITU601;
  }
}

std::string note_of_turn(Turn turn) {
  const auto how = [&] {
    switch (turn) {
      case Turn::clockwise:
        return "turned by 90 degrees clockwise";
      case Turn::half:
        return "turned by 180 degrees";
      case Turn::counterclockwise:
        return "turned by 90 degrees counterclockwise";
      case Turn::mirror:
        return "mirrored from left to right";
      case Turn::flip:
        return "mirrored from top to bottom";
      default:
        return "turned by 90 degrees and mirrored";
    }
  };
  return fmt::format(
      "its pictures are {} as the file asks and players do; the calibration must be of pictures "
      "that players show",
      how());
}

std::string note_of_slant(double degrees) {
  return fmt::format(
      "asks to be turned by {:.4g} degrees, which is not done; turn it by a multiple of 90 or "
      "remove its display matrix",
      -degrees);
}

void add_color_notes(const AVFrame& frame, const VideoColors& colors,
                     std::vector<std::string>& notes) {
  const AVPixFmtDescriptor* pixels = av_pix_fmt_desc_get(static_cast<AVPixelFormat>(frame.format));
  if (!pixels) return;
  constexpr std::uint64_t kRgb = AV_PIX_FMT_FLAG_RGB | AV_PIX_FMT_FLAG_PAL;
  const bool yuv = (pixels->flags & kRgb) == 0 && pixels->nb_components >= 3;
  for (std::string note : {note_of_matrix(frame, colors, yuv), note_of_range(frame, colors, yuv)})
    if (!note.empty()) notes.push_back(std::move(note));
  if (frame.color_trc == AVCOL_TRC_SMPTE2084 || frame.color_trc == AVCOL_TRC_ARIB_STD_B67)
    notes.push_back(
        "has high dynamic range, which is not mapped to that of a screen: colours are pale");
  if (pixels->flags & AV_PIX_FMT_FLAG_ALPHA) notes.push_back(kNoteOfAlpha);
  if (pixels->comp[0].depth > 8)
    notes.push_back(fmt::format("has {} bits per sample, of which the upper 8 are used",
                                pixels->comp[0].depth));
}

void add_shape_notes(const Demuxer& video, const AVFrame& frame, std::vector<std::string>& notes) {
  const AVStream& stream = video.pictures();
  const AVRational ratio =
      stream.sample_aspect_ratio.num > 0 ? stream.sample_aspect_ratio : frame.sample_aspect_ratio;
  if (ratio.num > 0 && ratio.den > 0 && ratio.num != ratio.den)
    notes.push_back(
        fmt::format("has pixels of {}:{}, which players stretch; they stay as stored, and the "
                    "calibration must be of stored pixels",
                    ratio.num, ratio.den));
  if (is_interlaced(frame))
    notes.push_back(
        "is interlaced: a picture holds two moments; deinterlace it first (ffmpeg -i FILE -vf "
        "bwdif OUT)");
  if (has_alpha_beside(stream)) notes.push_back(kNoteOfAlpha);
  int streams = 0;
  for (unsigned i = 0; i < video.format->nb_streams; ++i) {
    const AVStream& other = *video.format->streams[i];
    streams += other.codecpar->codec_type == AVMEDIA_TYPE_VIDEO &&
               !(other.disposition & AV_DISPOSITION_ATTACHED_PIC);
  }
  if (streams > 1)
    notes.push_back(
        fmt::format("has {} videos in it, of which number {} is read", streams, video.stream));
  if (std::string stereo = note_of_stereo(stream); !stereo.empty())
    notes.push_back(std::move(stereo));
}

}  // namespace hypotrack::internal
