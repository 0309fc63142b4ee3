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
#include "hypotrack/video_timeline.hpp"

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

void read_videos(const std::string& left, const std::string& right, int step,
                 const std::function<void(PicturePair)>& take,
                 const std::function<void(const std::string&)>& tell) {
  const std::array files{open_video(left), open_video(right)};
  const std::array infos{files[0]->info(), files[1]->info()};
  const VideoTimeline line = make_timeline(infos, {});
  for (const VideoInfo& info : infos) std::ranges::for_each(info.notes, tell);
  std::ranges::for_each(line.notes, tell);
  for (std::size_t i = 0; i < line.frames.size(); i += static_cast<std::size_t>(step)) {
    const TimelineFrame& frame = line.frames[i];
    if (!frame.complete()) continue;
    PicturePair pair{fmt::format("frame {}", frame.number.value_or(static_cast<int>(i))), {}, {}};
    std::string problem = files[0]->read(*frame.pictures[0], pair.left);
    if (problem.empty()) problem = files[1]->read(*frame.pictures[1], pair.right);
    if (problem.empty())
      take(std::move(pair));
    else
      tell(problem);
  }
  for (const VideoInfo& info : infos)
    if (!info.problem_of_end.empty()) tell(info.problem_of_end);
}

}  // namespace

void read_pairs(const std::string& left, const std::string& right, int step,
                const std::function<void(PicturePair)>& take,
                const std::function<void(const std::string&)>& tell) {
  const std::vector<std::string> first = files_of(left), second = files_of(right);
  if (first.size() != second.size()) {
    throw DataError(fmt::format("{} matches {} files, {} matches {}; expected as many of each",
                                left, first.size(), right, second.size()));
  }
  if (first.size() == 1 && is_video(first[0]))
    return read_videos(first[0], second[0], step, take, tell);
  for (std::size_t i = 0; i < first.size(); ++i)
    take({std::filesystem::path(first[i]).filename().string(), read_picture(first[i]),
          read_picture(second[i])});
}

}  // namespace hypotrack::calibrate
