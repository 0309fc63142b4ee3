#include "image_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "hypotrack/api/error.hpp"
#include "hypotrack/api/files.hpp"
#include "hypotrack/api/text.hpp"
#include "hypotrack/api/timeline.hpp"

namespace hypotrack::rgbd {
namespace {

constexpr std::uintmax_t kLargestList = std::uintmax_t{64} << 20;
constexpr std::string_view kBlank = " \t\r,";
constexpr long double kLatest = 4e9L;  // seconds; differences of nanoseconds do not overflow

std::string read_text(const std::filesystem::path& file) {
  std::error_code error;
  const std::string name = file.string();
  if (!std::filesystem::exists(file, error)) {
    throw DataError(name +
                    ": there is no such list; expected a TUM RGB-D recording with a time "
                    "and a file name per line in it");
  }
  if (!std::filesystem::is_regular_file(file, error)) throw DataError(name + ": is no file");
  if (std::filesystem::file_size(file, error) > kLargestList || error) {
    throw DataError(name + ": is larger than 64 MiB; expected a list of file names");
  }
  std::optional<std::string> text = read_whole(file);
  if (!text) throw DataError(name + ": cannot be read; check its permissions");
  if (text->find('\0') != std::string::npos) {
    throw DataError(name + ": is no text; expected a time and a file name per line");
  }
  if (text->starts_with("\xEF\xBB\xBF")) text->erase(0, 3);  // byte order mark of UTF-8
  return std::move(*text);
}

TimedImage read_line(std::string_view line, const std::filesystem::path& folder,
                     const std::string& where) {
  TimedImage image;
  const char* end = line.data() + line.size();
  long double seconds = 0;  // holds all numbers of 19 digits
  const auto [stop, failure] = std::from_chars(line.data(), end, seconds);
  const std::string_view rest(stop, static_cast<std::size_t>(end - stop));
  const std::string_view name = trimmed(rest, kBlank);
  const bool apart = !rest.empty() && kBlank.find(rest.front()) != std::string_view::npos;
  if (failure != std::errc{} || !(std::abs(seconds) <= kLatest) || !apart || name.empty()) {
    throw DataError(fmt::format(
        "{}: '{}' is not understood; expected a time in seconds and a file name, such as "
        "1305031102.175304 rgb/1305031102.175304.png",
        where, printable(line)));
  }
  image.time = static_cast<double>(seconds);
  image.stamp = std::llround(1e9L * seconds);
  image.file = folder / std::string(name);
  return image;
}

}  // namespace

std::vector<TimedImage> read_image_list(const std::filesystem::path& list) {
  const std::string text = read_text(list);
  std::vector<TimedImage> images;
  int number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line =
        trimmed(std::string_view(text).substr(begin, end - begin), kBlank);
    begin = end + 1;
    ++number;
    if (line.empty() || line.front() == '#') continue;
    const std::string where = fmt::format("{}:{}", list.string(), number);
    images.push_back(read_line(line, list.parent_path(), where));
    if (images.size() > 1 && images.back().stamp <= images[images.size() - 2].stamp) {
      throw DataError(fmt::format("{}: the time {} follows {}; expected times that ascend", where,
                                  images.back().time, images[images.size() - 2].time));
    }
  }
  if (images.empty()) throw DataError(list.string() + ": names no image; expected one per line");
  return images;
}

std::vector<std::int64_t> stamps_of(std::span<const TimedImage> images) {
  std::vector<std::int64_t> out;
  for (const TimedImage& image : images) out.push_back(image.stamp);
  return out;
}

std::vector<std::optional<std::size_t>> associate(std::span<const TimedImage> a,
                                                  std::span<const TimedImage> b,
                                                  double max_difference) {
  const std::array lists{stamps_of(a), stamps_of(b)};
  std::vector<std::optional<std::size_t>> partners(a.size());
  for (const TimedFrame& frame : pair_by_time(lists, std::llround(1e9 * max_difference)))
    if (frame.pictures[0]) partners[*frame.pictures[0]] = frame.pictures[1];
  return partners;
}

}  // namespace hypotrack::rgbd
