#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "camera/media/ffmpeg.hpp"

namespace hypotrack::internal {
namespace {

constexpr std::string_view kBlank = " \t\r\n";
constexpr const char* kPlaylist = "a playlist that names other files; give a video that it names";

/// Returns the first line that is not empty and no comment.
std::string_view first_line(std::string_view text) {
  while (!text.empty()) {
    text.remove_prefix(std::min(text.find_first_not_of(kBlank), text.size()));
    const std::string_view line = text.substr(0, text.find('\n'));
    if (!line.starts_with('#')) return line;
    text.remove_prefix(line.size());
  }
  return {};
}

/// Returns what a list is and what to do with it; empty if the text begins none.
std::string kind_of(std::string_view text) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";  // of UTF-8
  if (text.starts_with(kMark)) text.remove_prefix(kMark.size());
  const auto has = [&](std::string_view part) { return text.find(part) != text.npos; };
  const std::string_view line = first_line(text);
  if (line.starts_with("ffconcat version") || line.starts_with("file ") ||
      line.starts_with("file\t"))
    return "concat, a list that names other files; make one video of them: ffmpeg -f concat -safe "
           "0 -i LIST -c copy OUT.mkv";
  if (text.starts_with("v=0") && has("\nm="))
    return "sdp, which describes a live stream; give its address to the source `camera`";
  if (text.starts_with("#EXTM3U") && has("#EXT-X-"))
    return "hls, a playlist that names other files; make one video of them: ffmpeg -i LIST -c copy "
           "OUT.mkv";
  if (text.starts_with("<") && has("<MPD"))
    return "dash, a playlist that names other files; make one video of them: ffmpeg -i LIST -c "
           "copy OUT.mkv";
  if (text.starts_with("#EXTM3U") || line.starts_with("[playlist]") ||
      (text.starts_with("<") && has("<playlist")))
    return kPlaylist;
  return {};
}

}  // namespace

std::string problem_of_playlist(AVIOContext& io, std::string_view name) {
  std::string text(4096, '\0');
  const int size =
      avio_read(&io, reinterpret_cast<unsigned char*>(text.data()), static_cast<int>(text.size()));
  avio_seek(&io, 0, SEEK_SET);
  text.resize(static_cast<std::size_t>(std::max(size, 0)));
  std::string kind = kind_of(text);
  const bool plain = name.ends_with(".m3u") || name.ends_with(".m3u8");  // names of files alone
  if (kind.empty() && plain && text.find('\0') == text.npos) kind = kPlaylist;
  return kind.empty() ? "" : fmt::format("cannot be opened as a video: its format is {}", kind);
}

}  // namespace hypotrack::internal
