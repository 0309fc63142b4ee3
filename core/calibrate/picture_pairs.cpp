#include "calibrate/picture_pairs.hpp"

#include <fmt/format.h>
#include <glob.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <string_view>
#include <vector>

#include "hypotrack/error.hpp"
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

cv::Mat read_picture(const std::string& file) {
  cv::Mat out = read_image(file, cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION);
  if (out.empty())
    throw DataError(fmt::format("{}: cannot be read as a picture; is it damaged?", file));
  return out;
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

}  // namespace

void read_pairs(const std::string& left, const std::string& right, int step,
                const std::function<void(PicturePair)>& take) {
  const std::vector<std::string> first = files_of(left), second = files_of(right);
  if (first.size() != second.size()) {
    throw DataError(fmt::format("{} matches {} files, {} matches {}; expected as many of each",
                                left, first.size(), right, second.size()));
  }
  if (first.size() == 1 && is_video(first[0])) return read_videos(first[0], second[0], step, take);
  for (std::size_t i = 0; i < first.size(); ++i)
    take({std::filesystem::path(first[i]).filename().string(), read_picture(first[i]),
          read_picture(second[i])});
}

}  // namespace hypotrack::calibrate
