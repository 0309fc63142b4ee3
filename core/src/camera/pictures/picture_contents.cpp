#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <set>
#include <string>
#include <string_view>

#include "camera/pictures/orientation.hpp"
#include "camera/pictures/picture_container.hpp"
#include "hypotrack/api/image_file.hpp"

namespace hypotrack {
namespace {

using namespace std::string_view_literals;

/// Returns whether a picture of a TIFF file is a smaller copy of another (TIFF 6.0, section 8).
bool is_copy(const TiffDirectory& picture) {
  constexpr std::uint32_t kSubfileType = 254, kSmaller = 1;
  return (picture.value(kSubfileType) & kSmaller) != 0;
}

/// Returns the number of pictures of a TIFF file, without smaller copies of others.
std::size_t pictures_of_tiff(std::string_view bytes) {
  std::size_t count = 0;
  std::set<std::size_t> seen;
  for (TiffDirectory one = tiff_directory(bytes); one.is_inside && seen.insert(one.place).second;) {
    count += is_copy(one) ? 0 : 1;
    const std::size_t next = one.next();
    if (next == 0) break;
    one = tiff_directory(bytes, next);
  }
  return count;
}

/// Returns the number of pictures that belong together in a JPEG file, as those of stereo cameras
/// do (CIPA DC-007, 5.2.3.3). Previews do not count.
std::size_t pictures_of_index(std::string_view bytes) {
  constexpr std::uint32_t kEntries = 0xB002, kType = 0xFF0000, kMultiple = 0x020000;
  constexpr std::size_t kSize = 16;
  const TiffDirectory index = tiff_directory(bytes);
  const std::size_t entry = index.entry(kEntries), place = index.value(kEntries);
  if (entry == 0) return 0;
  const std::size_t length = std::min<std::size_t>(index.numbers.at(entry + 4, 4), bytes.size());
  std::size_t count = 0;
  for (std::size_t at = 0; at + kSize <= length; at += kSize)
    count += (index.numbers.at(place + at, 4) & kType) == kMultiple ? 1 : 0;
  return count;
}

/// Returns the number of pictures that a part of a file tells of; 0 if it tells of none.
std::size_t pictures_of_part(std::string_view name, std::string_view content) {
  constexpr std::string_view kIndex = "MPF\0"sv;
  if (name == "acTL") return Numbers(content, true).at(0, 4);
  if (name != "\xE2" || !content.starts_with(kIndex)) return 0;
  return pictures_of_index(content.substr(kIndex.size()));
}

/// Returns the name of an ICC profile (ICC.1, 7.3 and 9.2.41), of either form; `unknown` if
/// damaged.
std::string name_of_profile(std::string_view profile) {
  constexpr std::size_t kTable = 128, kEntry = 12, kMostTags = 100, kLongest = 60;
  const Numbers numbers(profile, true);
  const std::size_t tags = std::min<std::size_t>(numbers.at(kTable, 4), kMostTags);
  for (std::size_t i = 0; i < tags; ++i) {
    const std::size_t entry = kTable + 4 + kEntry * i, place = numbers.at(entry + 4, 4);
    if (numbers.at(entry, 4) != 0x64657363 || place >= profile.size()) continue;  // desc
    const std::string_view text = profile.substr(place);
    const bool wide = text.starts_with("mluc");
    const std::size_t length = numbers.at(place + (wide ? 20 : 8), 4);
    const std::size_t from = wide ? numbers.at(place + 24, 4) : 12;
    std::string name;
    for (const char c : text.substr(std::min(from, text.size()), std::min(length, 2 * kLongest)))
      if (c >= ' ' && c <= '~' && name.size() < kLongest) name += c;
    if (!name.empty()) return name;
  }
  return "unknown";
}

/// How a file says that its colours are meant.
struct Colors {
  std::string profile;   ///< its name; empty without one
  bool is_srgb = false;  ///< it says so
  double gamma = 0;      ///< 0: unsaid
};

void take_colors(std::string_view name, std::string_view content, Colors& out) {
  constexpr std::string_view kJpeg = "ICC_PROFILE\0"sv;
  constexpr std::size_t kLongest = 79;
  if (name == "iCCP") out.profile = content.substr(0, std::min(content.find('\0'), kLongest));
  if (name == "ICCP") out.profile = name_of_profile(content);
  if (name == "\xE2" && content.starts_with(kJpeg) && content.substr(kJpeg.size(), 1) == "\1")
    out.profile = name_of_profile(content.substr(std::min(kJpeg.size() + 2, content.size())));
  if (name == "sRGB") out.is_srgb = true;
  if (name == "gAMA") out.gamma = 1e-5 * Numbers(content, true).at(0, 4);
}

/// Returns how colours are meant if not as sRGB; empty otherwise.
std::string note_of(const Colors& colors) {
  constexpr double kSrgb = 0.45455, kNear = 0.01;
  if (!colors.profile.empty())
    return colors.profile.find("sRGB") != std::string::npos
               ? ""
               : fmt::format("its colour profile '{}' is not applied: numbers are taken for sRGB",
                             colors.profile);
  if (colors.is_srgb || colors.gamma == 0 || std::abs(colors.gamma - kSrgb) < kNear) return {};
  return fmt::format("its gamma of {:g} is not applied: numbers are taken for sRGB", colors.gamma);
}

/// Returns what a file holds beside the pixels that are read.
std::string note_on(std::string_view bytes) {
  constexpr std::uint32_t kProfile = 34675;
  std::size_t pictures = pictures_of_tiff(bytes);
  Colors colors;
  for_each_part(bytes, [&](std::string_view name, std::string_view content) {
    pictures = std::max(pictures, pictures_of_part(name, content));
    take_colors(name, content, colors);
    return name != "IDAT";
  });
  if (const TiffDirectory tiff = tiff_directory(bytes); tiff.entry(kProfile) != 0)
    colors.profile =
        name_of_profile(bytes.substr(std::min<std::size_t>(tiff.value(kProfile), bytes.size())));
  if (is_copy(tiff_directory(bytes)))
    return "its first picture, which is read, is a smaller copy of another, as in the raw files of "
           "cameras; convert them to PNG";
  const std::string of_colors = note_of(colors);
  if (pictures < 2) return of_colors;
  return fmt::format(
      "holds {} pictures, of which the first is read; write each into a file of its own{}{}",
      pictures, of_colors.empty() ? "" : "; ", of_colors);
}

/// Returns what a function says of the first file that can be read, behind its name.
template <class NoteOn>
std::string note_on_first(std::span<const std::filesystem::path> files, const NoteOn& note_of) {
  for (const std::filesystem::path& file : files) {
    FileBytes bytes;
    try {
      if (!read_picture_bytes(file, bytes).empty()) continue;
    } catch (const std::exception&) {  // memory; the frame says so
      return {};
    }
    const std::string note = note_of(bytes.view());
    return note.empty() ? "" : fmt::format("{}: {}", file.string(), note);
  }
  return {};
}

}  // namespace

std::string contents_note(std::span<const std::filesystem::path> files) {
  return note_on_first(files, note_on);
}

std::string mask_note(std::span<const std::filesystem::path> files) {
  return note_on_first(files, [](std::string_view bytes) {
    return bytes.starts_with("\xFF\xD8\xFF")
               ? "is a JPEG file, whose black is inexact: pixels beside the foreground count as "
                 "foreground; write masks as PNG"
               : "";
  });
}

}  // namespace hypotrack
