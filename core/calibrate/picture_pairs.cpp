#include "calibrate/picture_pairs.hpp"

#include <fmt/format.h>
#include <glob.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <string_view>
#include <utility>
#include <vector>

#include "hypotrack/error.hpp"
#include "hypotrack/image_file.hpp"
#include "hypotrack/media.hpp"

namespace hypotrack::calibrate {
namespace {

std::vector<std::string> files_of(const std::string& pattern) {
  glob_t found{};
  const int result = glob(pattern.c_str(), 0, nullptr, &found);
  std::vector<std::string> out;
  if (result == 0) out.assign(found.gl_pathv, found.gl_pathv + found.gl_pathc);
  globfree(&found);
  if (out.empty()) {
    throw DataError(fmt::format(
        "{}: no such picture; expected a file, or a pattern in quotes, as 'left*.jpg'", pattern));
  }
  return out;
}

bool is_video(const std::string& file) {
  constexpr std::array<std::string_view, 5> kVideos = {".mp4", ".avi", ".mkv", ".mov", ".webm"};
  std::string extension = std::filesystem::path(file).extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::ranges::find(kVideos, extension) != kVideos.end();
}

cv::Mat read_picture(const std::string& file, const std::optional<int>& bits) {
  ReadImage read = read_color(file, bits.value_or(16));
  if (!read.problem.empty()) throw DataError(read.problem);
  return read.image;
}

std::unique_ptr<VideoFile> opened(const std::string& file) {
  auto video = open_video(file);
  if (!video) throw DataError(fmt::format("{}: cannot be opened as a video", file));
  return video;
}

void read_videos(const std::string& left, const std::string& right, int step,
                 const std::function<void(PicturePair)>& take) {
  const auto first = opened(left), second = opened(right);
  for (int i = 0; first->grab() && second->grab(); ++i) {
    if (i % step != 0) continue;
    PicturePair pair{fmt::format("frame {}", i), {}, {}};
    if (first->retrieve(pair.left) && second->retrieve(pair.right)) take(std::move(pair));
  }
}

/// Reads pairs of whole pictures.
void read_whole_pairs(const PairFiles& files, const std::function<void(PicturePair)>& take) {
  const std::vector<std::string> first = files_of(files.left), second = files_of(files.right);
  if (first.size() != second.size()) {
    throw DataError(fmt::format("{} matches {} files, {} matches {}; expected as many of each",
                                files.left, first.size(), files.right, second.size()));
  }
  if (first.size() == 1 && is_video(first[0]))
    return read_videos(first[0], second[0], files.step, take);
  for (std::size_t i = 0; i < first.size(); ++i)
    take({std::filesystem::path(first[i]).filename().string(), read_picture(first[i], files.bits),
          read_picture(second[i], files.bits)});
}

}  // namespace

void read_pairs(const PairFiles& files, const std::function<void(PicturePair)>& take) {
  if (!files.layout) return read_whole_pairs(files, take);
  PairFiles whole = files;
  whole.right = files.left;
  read_whole_pairs(whole, [&](PicturePair pair) {
    view_size(*files.layout, pair.left.cols, pair.left.rows, pair.name);
    pair.left = split_views(*files.layout, pair.left)[0];
    pair.right = split_views(*files.layout, pair.right)[1];
    take(std::move(pair));
  });
}

std::vector<std::string> notes_on(const PairFiles& files) {
  std::vector<std::string> notes;
  for (const std::string& pattern : {files.left, files.right}) {
    if (pattern.empty()) continue;
    const std::vector<std::string> names = files_of(pattern);
    if (is_video(names[0])) continue;
    const std::vector<std::filesystem::path> paths(names.begin(), names.end());
    for (std::string note : {orientation_note(paths), bits_note(paths, files.bits, "--bits")})
      if (!note.empty()) notes.push_back(std::move(note));
  }
  return notes;
}

}  // namespace hypotrack::calibrate
