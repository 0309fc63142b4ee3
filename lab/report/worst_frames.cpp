#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <opencv2/imgproc.hpp>

#include "hypotrack/api/error.hpp"
#include "hypotrack/api/media.hpp"
#include "lab/json_file.hpp"
#include "lab/report/packed.hpp"
#include "lab/report/report_data.hpp"

namespace hypotrack::internal {
namespace {

namespace fs = std::filesystem;

/// Returns the frame number of `worst_000123.jpg`, -1 for other names.
int frame_of(const std::string& name) {
  constexpr std::string_view kBefore = "worst_", kAfter = ".jpg";
  if (!name.starts_with(kBefore) || !name.ends_with(kAfter)) return -1;
  const char* first = name.data() + kBefore.size();
  const char* last = name.data() + name.size() - kAfter.size();
  int frame = -1;
  const auto [end, error] = std::from_chars(first, last, frame);
  return error == std::errc{} && end == last ? frame : -1;
}

std::string inlined(const fs::path& file, const PictureLimits& limits) {
  cv::Mat picture = read_image(file.string(), cv::IMREAD_COLOR);
  if (picture.empty())
    throw DataError(fmt::format(
        "{}: is no picture that can be read; repeat the run that wrote it, or remove it",
        file.string()));
  const int longest = std::max(picture.rows, picture.cols);
  if (longest > limits.longest_side) {
    const double scale = static_cast<double>(limits.longest_side) / longest;
    cv::resize(picture, picture, {}, scale, scale, cv::INTER_AREA);
  }
  return "data:image/jpeg;base64," +
         base64(encode_image(".jpg", picture, {cv::IMWRITE_JPEG_QUALITY, limits.quality}));
}

}  // namespace

Json worst_frames(const fs::path& run, const PictureLimits& limits) {
  std::map<int, fs::path> files;
  for (const auto& entry : fs::directory_iterator(run))
    if (const int frame = frame_of(entry.path().filename().string()); frame >= 0)
      files[frame] = entry.path();
  Json pictures = Json::array();
  for (const auto& [frame, file] : files)
    if (static_cast<int>(pictures.size()) < limits.count)
      pictures.push_back({{"frame", frame}, {"src", inlined(file, limits)}});
  return pictures;
}

}  // namespace hypotrack::internal
