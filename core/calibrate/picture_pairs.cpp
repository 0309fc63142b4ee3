#include "calibrate/picture_pairs.hpp"

#include <fmt/format.h>
#include <glob.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "hypotrack/api/error.hpp"
#include "hypotrack/api/image_file.hpp"
#include "hypotrack/api/media.hpp"
#include "hypotrack/api/timeline.hpp"

namespace hypotrack::calibrate {
namespace {

/// Compares names as people sort them: `left9` is before `left10`.
bool before(const std::string& a, const std::string& b) {
  const auto digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (!digit(a[i]) || !digit(b[j])) {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i, ++j;
      continue;
    }
    const auto number = [&](const std::string& text, std::size_t& at) {
      const std::size_t from = std::min(text.find_first_not_of('0', at), text.size());
      for (at = from; at < text.size() && digit(text[at]);) ++at;
      return std::string_view(text).substr(from, at - from);
    };
    const std::string_view x = number(a, i), y = number(b, j);
    if (x.size() != y.size()) return x.size() < y.size();
    if (x != y) return x < y;
  }
  return std::pair(a.size() - i, a) < std::pair(b.size() - j, b);
}

/// Returns the last number in a file's name as it is written, without zeros before it.
std::string number_of(const std::filesystem::path& file) {
  const std::string name = file.stem().string();
  const std::size_t last = name.find_last_of("0123456789");
  if (last == std::string::npos) return {};
  const std::size_t other = name.find_last_not_of("0123456789", last);
  const std::string digits = name.substr(other + 1, last - other);  // npos + 1 is 0
  return digits.substr(std::min(digits.find_first_not_of('0'), digits.size() - 1));
}

/// Returns that files are not paired by the numbers in their names although both sides have these;
/// empty otherwise.
std::string order_note(const std::vector<std::string>& left,
                       const std::vector<std::string>& right) {
  std::vector<std::string> numbers;
  for (const std::string& file : right) numbers.push_back(number_of(file));
  for (std::size_t i = 0; i < left.size() && i < right.size(); ++i) {
    const std::string number = number_of(left[i]);
    const auto same = std::ranges::find(numbers, number);
    if (number.empty() || numbers[i] == number || same == numbers.end()) continue;
    const auto name = [](const std::string& file) {
      return std::filesystem::path(file).filename().string();
    };
    return fmt::format("{} is paired with {}, not with {}: files pair in the order of their names",
                       name(left[i]), name(right[i]),
                       name(right[static_cast<std::size_t>(same - numbers.begin())]));
  }
  return {};
}

std::vector<std::string> files_of(const std::string& pattern) {
  glob_t found{};
  const int result = glob(pattern.c_str(), 0, nullptr, &found);
  std::vector<std::string> out;
  if (result == 0) out.assign(found.gl_pathv, found.gl_pathv + found.gl_pathc);
  globfree(&found);
  std::ranges::sort(out, before);
  if (out.empty()) {
    throw DataError(fmt::format(
        "{}: no such picture; expected a file, or a pattern in quotes, as 'left*.jpg'", pattern));
  }
  return out;
}

bool ends_with_one_of(const std::filesystem::path& file,
                      std::initializer_list<std::string_view> endings) {
  std::string ending = file.extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::ranges::find(endings, ending) != endings.end();
}

/// Returns whether a file may be a list of videos, which the reader of videos refuses with advice.
bool may_be_playlist(const std::filesystem::path& file) {
  return ends_with_one_of(file, {".ffconcat", ".m3u", ".m3u8", ".mpd", ".pls", ".txt", ".xspf"});
}

cv::Mat read_picture(const std::string& file, const std::optional<int>& bits) {
  ReadImage read = read_color(file, bits.value_or(16));
  if (!read.problem.empty()) throw DataError(read.problem);
  return read.image;
}

/// Reads frames of two videos, or of one with both views, which both pictures of a pair then are.
void read_videos(const std::vector<std::string>& names, const PairFiles& settings,
                 const std::function<void(PicturePair)>& take,
                 const std::function<void(const std::string&)>& tell) {
  std::vector<std::unique_ptr<VideoFile>> files;
  std::vector<VideoInfo> infos;
  for (const std::string& name : names) {
    files.push_back(open_video(name, settings.colors));
    infos.push_back(files.back()->info());
    std::ranges::for_each(infos.back().notes, tell);
  }
  const VideoTimeline line = make_timeline(infos, {});
  std::ranges::for_each(line.notes, tell);
  for (std::size_t i = 0; i < line.frames.size(); i += static_cast<std::size_t>(settings.step)) {
    const TimelineFrame& frame = line.frames[i];
    if (!frame.complete()) continue;
    std::array<cv::Mat, 2> pictures;
    std::string problem;
    for (std::size_t v = 0; v < files.size() && problem.empty(); ++v)
      problem = files[v]->read(*frame.pictures[v], pictures[v]);
    if (problem.empty())
      take({fmt::format("frame {}", frame.number.value_or(static_cast<int>(i))), pictures[0],
            pictures[files.size() - 1]});
    else
      tell(problem);
  }
  for (const VideoInfo& info : infos)
    if (!info.problem_of_end.empty()) tell(info.problem_of_end);
}

/// Reads pairs of whole pictures.
void read_whole_pairs(const PairFiles& files, const std::function<void(PicturePair)>& take,
                      const std::function<void(const std::string&)>& tell) {
  const std::vector<std::string> first = files_of(files.left), second = files_of(files.right);
  if (first.size() != second.size()) {
    throw DataError(fmt::format("{} matches {} files, {} matches {}; expected as many of each",
                                files.left, first.size(), files.right, second.size()));
  }
  if (first.size() == 1 && (is_video(first[0]) || may_be_playlist(first[0])))
    return read_videos(files.layout ? first : std::vector{first[0], second[0]}, files, take, tell);
  if (const std::string note = order_note(first, second); !note.empty()) tell(note);
  for (std::size_t i = 0; i < first.size(); ++i)
    take({std::filesystem::path(first[i]).filename().string(), read_picture(first[i], files.bits),
          read_picture(second[i], files.bits)});
}

}  // namespace

bool is_video(const std::filesystem::path& file) {
  return ends_with_one_of(
      file, {".3gp", ".asf", ".avi", ".flv", ".m2ts", ".m4v", ".mkv", ".mov", ".mp4", ".mpeg",
             ".mpg", ".mts", ".mxf", ".nut", ".ogv", ".ts", ".webm", ".wmv"});
}

void read_pairs(const PairFiles& files, const std::function<void(PicturePair)>& take,
                const std::function<void(const std::string&)>& tell) {
  if (!files.layout) return read_whole_pairs(files, take, tell);
  PairFiles whole = files;
  whole.right = files.left;
  const auto split = [&](PicturePair pair) {
    view_size(*files.layout, pair.left.cols, pair.left.rows, pair.name);
    pair.left = split_views(*files.layout, pair.left)[0];
    pair.right = split_views(*files.layout, pair.right)[1];
    take(std::move(pair));
  };
  read_whole_pairs(whole, split, tell);
}

std::vector<std::string> notes_on(const PairFiles& files) {
  std::vector<std::string> notes;
  for (const std::string& pattern : {files.left, files.right}) {
    if (pattern.empty()) continue;
    const std::vector<std::string> names = files_of(pattern);
    if (is_video(names[0])) continue;
    const std::vector<std::filesystem::path> paths(names.begin(), names.end());
    for (std::string note :
         {orientation_note(paths), contents_note(paths), bits_note(paths, files.bits, "--bits")})
      if (!note.empty()) notes.push_back(std::move(note));
  }
  return notes;
}

}  // namespace hypotrack::calibrate
