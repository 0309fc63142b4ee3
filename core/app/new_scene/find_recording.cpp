#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "calibrate/picture_pairs.hpp"
#include "hypotrack/api/error.hpp"
#include "new_scene/scene_request.hpp"

namespace hypotrack::app {
namespace {

namespace fs = std::filesystem;

/// Names of the left and the right view in file and folder names.
using Words = std::pair<std::string_view, std::string_view>;

/// The files of one view that differ in a number only.
struct Numbered {
  int count = 0;
  std::size_t width = 0;  ///< digits of numbers with leading zeros; 0: none has any
  bool is_long = false;   ///< numbers that are too large to be counted, such as times
};

/// The files of a pair, by the text that stands for the name of the view.
struct Candidate {
  Numbered left, right;
};

/// A file name without the name of its view and without its number.
struct Key {
  std::string before, after;  ///< around the number
  bool has_number = false;
  auto operator<=>(const Key&) const = default;
};

constexpr char view_mark() { return '\1'; }

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

bool is_picture(const fs::path& file) {
  constexpr std::array<std::string_view, 10> kEndings = {".png", ".jpg", ".jpeg", ".bmp",  ".tif",
                                                         ".ppm", ".pgm", ".tiff", ".webp", ".pnm"};
  std::string ending = file.extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
  return std::ranges::count(kEndings, ending) > 0;
}

/// Lists pictures and videos, relative to the folder.
std::vector<std::string> media_in(const fs::path& folder) {
  constexpr int kDepth = 2;
  std::vector<std::string> out;
  std::error_code error;
  for (fs::recursive_directory_iterator it(folder, error), end; !error && it != end;
       it.increment(error)) {
    if (it.depth() >= kDepth) it.disable_recursion_pending();
    const std::string name = it->path().filename().string();
    const bool other =
        name.find("mask") != std::string::npos || name.find("depth") != std::string::npos;
    if (other || !(is_picture(name) || calibrate::is_video(name))) continue;
    std::error_code ignored;
    if (it->is_regular_file(ignored))
      out.push_back(it->path().lexically_relative(folder).generic_string());
  }
  return out;
}

/// Replaces every `word` of a name by the mark of a view; nothing if there is none.
std::optional<std::string> without_view(const std::string& name, std::string_view word) {
  std::string out;
  std::size_t done = 0;
  for (std::size_t at = 0; (at = name.find(word, done)) != std::string::npos;) {
    const std::size_t end = at + word.size();
    const bool longer = is_digit(word.back()) && end < name.size() && is_digit(name[end]);
    out += name.substr(done, at - done);
    out += longer ? name.substr(at, word.size()) : std::string(1, view_mark());
    done = end;
  }
  out += name.substr(done);
  return out == name ? std::nullopt : std::optional(out);
}

/// Takes the number out of a picture's name and counts it for its view.
Key key_of(const std::string& name, std::string& digits) {
  if (calibrate::is_video(name)) return {name, "", false};
  const std::size_t slash = name.rfind('/') == std::string::npos ? 0 : name.rfind('/') + 1;
  std::size_t end = name.rfind('.');
  while (end > slash && !is_digit(name[end - 1])) --end;
  std::size_t begin = end;
  while (begin > slash && is_digit(name[begin - 1])) --begin;
  digits = name.substr(begin, end - begin);
  if (digits.empty()) return {name, "", false};
  return {name.substr(0, begin), name.substr(end), true};
}

void count(Numbered& view, const std::string& digits) {
  constexpr std::size_t kMostDigits = 9;
  ++view.count;
  view.is_long = view.is_long || digits.size() > kMostDigits;
  if (digits.size() > 1 && digits.front() == '0')
    view.width = view.width == 0 ? digits.size() : std::min(view.width, digits.size());
}

/// Returns the file of one view, or the pattern of its pictures.
fs::path files_of(const fs::path& folder, const Key& key, const Candidate& found,
                  std::string_view word) {
  const auto part = [&](std::string_view text, bool in_pattern) {
    std::string out;
    for (const char c : text) {
      if (c == view_mark())
        out += word;
      else
        out.append(c == '%' && in_pattern ? 2 : 1, c);
    }
    return out;
  };
  if (calibrate::is_video(key.before)) return folder / part(key.before, false);
  std::string number = "%d";
  const std::size_t width = std::max(found.left.width, found.right.width);
  if (width > 0) number = fmt::format("%0{}d", width);
  if (found.left.is_long || found.right.is_long) number = "*";
  return fs::path(part(folder.string(), true)) /
         (part(key.before, true) + (key.has_number ? number : "") + part(key.after, true));
}

/// Returns the pairs that names tell by two words, most files first.
std::vector<std::pair<Key, Candidate>> pairs_by(const std::vector<std::string>& names,
                                                const Words& words) {
  std::map<Key, Candidate> all;
  for (const std::string& name : names) {
    const auto add = [&](std::string_view word, Numbered Candidate::*view) {
      const auto marked = without_view(name, word);
      if (!marked) return;
      std::string digits;
      const Key key = key_of(*marked, digits);
      count(all[key].*view, digits);
    };
    add(words.first, &Candidate::left);
    add(words.second, &Candidate::right);
  }
  std::vector<std::pair<Key, Candidate>> out;
  for (const auto& entry : all)
    if (entry.second.left.count > 0 && entry.second.right.count > 0) out.push_back(entry);
  std::ranges::stable_sort(out, std::greater(), [](const auto& entry) {
    return std::min(entry.second.left.count, entry.second.right.count);
  });
  return out;
}

fs::path find_calibration(const fs::path& folder) {
  for (const char* name : {"calibration.yaml", "calibration.yml", "intrinsics.yaml",
                           "intrinsics.yml", "stereo.yaml", "stereo.yml"})
    if (fs::is_regular_file(folder / name)) return folder / name;
  return {};
}

}  // namespace

void add_extrinsics(RecordingFiles& files) {
  if (files.calibration.stem() != "intrinsics") return;
  const fs::path second =
      files.calibration.parent_path() / ("extrinsics" + files.calibration.extension().string());
  if (fs::is_regular_file(second)) files.extrinsics = second;
}

RecordingFiles find_recording(const fs::path& folder) {
  constexpr std::array<Words, 9> kWords = {{{"left", "right"},
                                            {"Left", "Right"},
                                            {"LEFT", "RIGHT"},
                                            {"cam0", "cam1"},
                                            {"cam_0", "cam_1"},
                                            {"camera0", "camera1"},
                                            {"camera_0", "camera_1"},
                                            {"image_0", "image_1"},
                                            {"cam1", "cam2"}}};
  const std::vector<std::string> names = media_in(folder);
  RecordingFiles files;
  for (const Words& words : kWords) {
    const auto pairs = pairs_by(names, words);
    if (pairs.empty()) continue;
    const auto& [key, found] = pairs.front();
    files.left = files_of(folder, key, found, words.first);
    files.right = files_of(folder, key, found, words.second);
    if (pairs.size() > 1)
      throw DataError(fmt::format(
          "{}: holds more than one pair, such as {} and {}; name one with --left and --right",
          folder.string(), files.left.filename().string(),
          files_of(folder, pairs[1].first, pairs[1].second, words.first).filename().string()));
    files.calibration = find_calibration(folder);
    add_extrinsics(files);
    return files;
  }
  throw DataError(
      fmt::format("{}: no pair was found among {} pictures and videos; expected names with left "
                  "and right, or cam0 and cam1; name the files with --left and --right",
                  folder.string(), names.size()));
}

}  // namespace hypotrack::app
