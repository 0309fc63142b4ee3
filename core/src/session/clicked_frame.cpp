#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <string_view>
#include <system_error>
#include <utility>

#include "hypotrack/api/clicks.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack {
namespace {

std::string summary(const cv::Mat& picture) {
  const cv::Size cells(8, 6);
  cv::Mat gray = picture;
  if (picture.channels() == 3) cv::cvtColor(picture, gray, cv::COLOR_BGR2GRAY);
  cv::Mat1b small;
  cv::resize(gray, small, cells, 0, 0, cv::INTER_AREA);
  std::string out;
  for (const unsigned char level : small) out += fmt::format("{:02x}", level);
  return out;
}

/// Returns the largest difference of two summaries in grey levels; infinite if they cannot be
/// compared.
double difference_of(const std::string& a, const std::string& b) {
  if (a.size() != b.size()) return std::numeric_limits<double>::infinity();
  int most = 0;
  for (std::size_t i = 0; i + 1 < a.size(); i += 2) {
    std::array<int, 2> levels{};
    for (const auto& [text, level] : {std::pair(&a, &levels[0]), std::pair(&b, &levels[1])}) {
      const char* const begin = text->data() + i;
      const auto [end, error] = std::from_chars(begin, begin + 2, *level, 16);
      if (error != std::errc() || end != begin + 2) return std::numeric_limits<double>::infinity();
    }
    most = std::max(most, std::abs(levels[0] - levels[1]));
  }
  return most;
}

}  // namespace

std::vector<std::string> summaries(const Frame& frame) {
  std::vector<std::string> out;
  for (const View& view : frame.views)
    if (!view.color.empty() && out.size() < 2) out.push_back(summary(view.color));
  return out;
}

void expect_clicked_frame(const ClickedFrame& clicked, const Frame& frame,
                          const std::string& where) {
  constexpr double kMost = 8;  // grey levels; another way of compressing pictures changes a few
  const std::vector<std::string> found = summaries(frame);
  bool same = clicked.pictures.empty() || found.size() == clicked.pictures.size();
  for (std::size_t i = 0; same && i < clicked.pictures.size(); ++i)
    same = difference_of(found[i], clicked.pictures[i]) <= kMost;
  if (same) return;
  const std::string of =
      clicked.frame ? fmt::format("in frame {} of their scene", *clicked.frame) : "elsewhere";
  throw DataError(fmt::format(
      "{}: the landmarks were clicked {}, whose pictures are not those of frame {}, where this run "
      "begins; expected the same pictures. Let the source begin there (`start`), click anew with "
      "`hypotrack click`, or remove `pictures` from the file",
      where, of, frame.index));
}

}  // namespace hypotrack
