#include "hand_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <vector>

#include "hypotrack/api/error.hpp"

namespace hypotrack::hands {
namespace {

constexpr float kWhite = 255;
constexpr std::array<float, 3> kColor = {1 / kWhite, 1 / kWhite, 1 / kWhite};
constexpr std::array<float, 3> kSkin = {1 / kWhite, 0.75f / kWhite, 0.6f / kWhite};

bool has_color(const cv::Mat& picture) {
  if (picture.channels() == 1) return false;
  for (int y = 0; y < picture.rows; ++y) {
    const auto* row = picture.ptr<cv::Vec3b>(y);
    const auto is_colored = [](const cv::Vec3b& p) { return p[0] != p[1] || p[1] != p[2]; };
    if (std::any_of(row, row + picture.cols, is_colored)) return true;
  }
  return false;
}

/// Returns which byte of a pixel is its red, green or blue.
int byte_of(const HandPicture& picture, int channel) {
  return picture.pixels.channels() == 3 ? 2 - channel : 0;
}

/// Writes pixels by linear interpolation between the four around them.
class Sampler {
 public:
  explicit Sampler(const HandPicture& picture)
      : picture_(picture),
        step_(picture.pixels.channels()),
        bytes_{byte_of(picture, 0), byte_of(picture, 1), byte_of(picture, 2)} {}

  /// Writes the pixel at (x, y) of the picture, which is black outside.
  void write(double x, double y, float* rgb) const {
    const double left = std::floor(x), top = std::floor(y);
    const cv::Mat& pixels = picture_.pixels;
    if (!(left >= -1 && top >= -1 && left < pixels.cols && top < pixels.rows)) {
      std::fill_n(rgb, 3, 0.0f);
      return;
    }
    const int x0 = static_cast<int>(left), y0 = static_cast<int>(top);
    const auto dx = static_cast<float>(x - left), dy = static_cast<float>(y - top);
    if (x0 >= 0 && y0 >= 0 && x0 + 1 < pixels.cols && y0 + 1 < pixels.rows) {
      const uchar* upper = pixels.ptr(y0) + x0 * step_;
      const uchar* lower = pixels.ptr(y0 + 1) + x0 * step_;
      mix({upper, upper + step_, lower, lower + step_}, dx, dy, rgb);
      return;
    }
    mix({at(x0, y0), at(x0 + 1, y0), at(x0, y0 + 1), at(x0 + 1, y0 + 1)}, dx, dy, rgb);
  }

 private:
  const uchar* at(int x, int y) const {
    static constexpr std::array<uchar, 3> kBlack{};
    const cv::Mat& pixels = picture_.pixels;
    if (x < 0 || y < 0 || x >= pixels.cols || y >= pixels.rows) return kBlack.data();
    return pixels.ptr(y) + x * step_;
  }

  void mix(const std::array<const uchar*, 4>& corners, float dx, float dy, float* rgb) const {
    for (std::size_t c = 0; c < 3; ++c) {
      const auto value = [&](std::size_t i) { return static_cast<float>(corners[i][bytes_[c]]); };
      const float upper = value(0) + dx * (value(1) - value(0));
      const float lower = value(2) + dx * (value(3) - value(2));
      rgb[c] = picture_.factors[c] * (upper + dy * (lower - upper));
    }
  }

  const HandPicture& picture_;
  int step_;                  // bytes of a pixel
  std::array<int, 3> bytes_;  // of red, green and blue in a pixel
};

/// The pixels of a row or column that an output pixel covers, and their weights, which sum to 1.
struct Span {
  int first = 0;
  std::vector<float> weights;
};

/// Returns the spans of `to` output pixels from `from` pixels: what they cover where the picture
/// shrinks, else the two pixels around their middles.
std::vector<Span> spans(int from, int to) {
  const double scale = double(from) / to;
  std::vector<Span> out;
  for (int i = 0; i < to; ++i) {
    Span span;
    if (scale > 1) {
      const double begin = i * scale, end = std::min((i + 1) * scale, double(from));
      span.first = static_cast<int>(begin);
      for (int k = span.first; k < end; ++k)
        span.weights.push_back(
            static_cast<float>((std::min(k + 1.0, end) - std::max(double(k), begin)) / scale));
    } else {
      const double middle = std::clamp((i + 0.5) * scale - 0.5, 0.0, from - 1.0);
      span.first = std::min(static_cast<int>(middle), std::max(from - 2, 0));
      const auto share = static_cast<float>(middle - span.first);
      span.weights = from > 1 ? std::vector{1 - share, share} : std::vector{1.0f};
    }
    out.push_back(std::move(span));
  }
  return out;
}

/// Sets `sums` to the weighted sum of the rows of a span, byte by byte.
void sum_rows(const cv::Mat& part, const Span& span, std::vector<float>& sums) {
  std::ranges::fill(sums, 0.0f);
  const std::size_t count = sums.size();
  float* const to = sums.data();
  for (std::size_t k = 0; k < span.weights.size(); ++k) {
    const uchar* row = part.ptr(span.first + static_cast<int>(k));
    const float weight = span.weights[k];
    for (std::size_t i = 0; i < count; ++i) to[i] += weight * static_cast<float>(row[i]);
  }
}

}  // namespace

HandPicture hand_picture(const cv::Mat& picture) {
  if (picture.empty()) throw DataError("the hand detector was given an empty picture");
  if (picture.dims != 2 || (picture.type() != CV_8UC1 && picture.type() != CV_8UC3)) {
    throw DataError(
        fmt::format("the hand detector was given a picture of {}; expected 8-bit BGR or grey",
                    cv::typeToString(picture.type())));
  }
  return {picture, has_color(picture) ? kColor : kSkin};
}

void write_region(const HandPicture& picture, const Region& region, int side,
                  std::span<float> output) {
  const Eigen::Matrix2d a = rotation_of(region) * (region.side / side);
  const Eigen::Vector2d first = region.center - a * Eigen::Vector2d::Constant((side - 1) / 2.0);
  const Sampler sampler(picture);
  float* to = output.data();
  for (int v = 0; v < side; ++v) {
    for (int u = 0; u < side; ++u, to += 3) {
      const Eigen::Vector2d at = first + a.col(0) * u + a.col(1) * v;
      sampler.write(at.x(), at.y(), to);
    }
  }
}

void write_letterbox(const HandPicture& picture, const cv::Rect& part, int side,
                     std::span<float> output) {
  const double scale = double(side) / std::max(part.width, part.height);
  const int width = std::max(1, static_cast<int>(std::lround(part.width * scale)));
  const int height = std::max(1, static_cast<int>(std::lround(part.height * scale)));
  const int left = (side - width) / 2, top = (side - height) / 2;
  const std::vector<Span> columns = spans(part.width, width), rows = spans(part.height, height);
  const cv::Mat pixels = picture.pixels(part);
  const auto step = static_cast<std::size_t>(pixels.channels());
  std::vector<float> sums(static_cast<std::size_t>(part.width) * step);
  std::ranges::fill(output, 0.0f);
  for (std::size_t y = 0; y < rows.size(); ++y) {
    sum_rows(pixels, rows[y], sums);
    float* to =
        output.data() + 3 * ((y + static_cast<std::size_t>(top)) * static_cast<std::size_t>(side) +
                             static_cast<std::size_t>(left));
    for (const Span& column : columns) {
      for (int c = 0; c < 3; ++c) {
        const float* from = sums.data() + static_cast<std::size_t>(column.first) * step +
                            static_cast<std::size_t>(byte_of(picture, c));
        float sum = 0;
        for (std::size_t k = 0; k < column.weights.size(); ++k)
          sum += column.weights[k] * from[k * step];
        *to++ = picture.factors[static_cast<std::size_t>(c)] * sum;
      }
    }
  }
}

}  // namespace hypotrack::hands
