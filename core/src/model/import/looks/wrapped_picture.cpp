#include "model/import/looks/wrapped_picture.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace hypotrack::internal {
namespace {

using mesh_wire::Wrap;

constexpr float kRim = 1e-4f;       // rounding errors of exporters
constexpr int kLargestSide = 4096;  // pixels

/// Returns the pixel of a row of `count` that stands at a place in the row's continuation.
int wrapped(std::int64_t place, int count, Wrap wrap) {
  if (wrap == Wrap::clamp) return static_cast<int>(std::clamp<std::int64_t>(place, 0, count - 1));
  const std::int64_t period = wrap == Wrap::mirror ? 2 * std::int64_t{count} : count;
  const std::int64_t rest = (place % period + period) % period;
  return static_cast<int>(rest < count ? rest : period - 1 - rest);
}

/// The pixels of a window along an axis: from `begin` to `end` in the picture's continuation.
struct Range {
  std::int64_t begin, end;
  int count() const { return static_cast<int>(end - begin); }
};

Range range(float low, float high, int count) {
  constexpr float kFilter = 0.5f;  // what a bilinear filter needs beyond
  const float pixels = static_cast<float>(count);
  return {low < 0 ? static_cast<std::int64_t>(std::floor(low * pixels - kFilter)) : 0,
          high > 1 ? static_cast<std::int64_t>(std::ceil(high * pixels + kFilter)) : count};
}

}  // namespace

UvCorners PictureWindow::moved(const UvCorners& uv) const {
  if ((low == 0).all() && (size == 1).all()) return uv;
  UvCorners out;
  for (int axis = 0; axis < 2; ++axis)
    out.row(axis) = ((uv.row(axis).cast<double>().array() - low[axis]) / size[axis]).cast<float>();
  return out;
}

UvCorners WrappedPicture::near_picture(const UvCorners& uv) const {
  UvCorners out = uv;
  for (int axis = 0; axis < 2; ++axis) {
    auto row = out.row(axis);
    const Wrap wrap = wrap_[static_cast<std::size_t>(axis)];
    if (wrap == Wrap::clamp) {
      if (row.minCoeff() >= 1 || row.maxCoeff() <= 0) row = row.cwiseMax(0.0f).cwiseMin(1.0f);
    } else if (row.minCoeff() < -kRim || row.maxCoeff() > 1 + kRim) {
      const float period = wrap == Wrap::mirror ? 2 : 1;
      const float middle = (row.minCoeff() + row.maxCoeff()) / 2;
      row.array() -= period * std::floor(middle / period);
    }
    if (row.minCoeff() >= -kRim && row.maxCoeff() <= 1 + kRim)
      row = row.cwiseMax(0.0f).cwiseMin(1.0f);
  }
  return out;
}

Eigen::Vector3f WrappedPicture::at(const Eigen::Vector2f& uv) const {
  const std::array<int, 2> sizes = {image_.cols, image_.rows};
  std::array<std::array<int, 2>, 2> pixels{};
  std::array<float, 2> share{};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const float place =
        uv[static_cast<Eigen::Index>(axis)] * static_cast<float>(sizes[axis]) - 0.5f;
    const float before = std::floor(place);
    share[axis] = place - before;
    for (int k = 0; k < 2; ++k)
      pixels[axis][static_cast<std::size_t>(k)] =
          wrapped(static_cast<std::int64_t>(before) + k, sizes[axis], wrap_[axis]);
  }
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (std::size_t y = 0; y < 2; ++y) {
    for (std::size_t x = 0; x < 2; ++x) {
      const cv::Vec3b& bgr = image_(image_.rows - 1 - pixels[1][y], pixels[0][x]);
      sum += (x ? share[0] : 1 - share[0]) * (y ? share[1] : 1 - share[1]) *
             Eigen::Vector3f(bgr[0], bgr[1], bgr[2]);
    }
  }
  return sum;
}

PictureWindow WrappedPicture::window(const Eigen::Array2f& low, const Eigen::Array2f& high) const {
  PictureWindow out;
  cv::Mat3b picture = image_;
  Range columns = range(low[0], high[0], picture.cols);
  Range rows = range(low[1], high[1], picture.rows);
  const int beyond = std::max(columns.count() > picture.cols ? columns.count() : 0,
                              rows.count() > picture.rows ? rows.count() : 0);
  if (beyond > kLargestSide) {
    out.shrink = static_cast<double>(kLargestSide) / beyond;
    const auto side = [&](int pixels) {
      return std::max(1, static_cast<int>(out.shrink * pixels));
    };
    cv::resize(image_, picture, {side(image_.cols), side(image_.rows)}, 0, 0, cv::INTER_AREA);
    columns = range(low[0], high[0], picture.cols);
    rows = range(low[1], high[1], picture.rows);
  }
  if (columns.count() == picture.cols && rows.count() == picture.rows) {
    out.pixels = picture;
    return out;
  }
  out.pixels.create(rows.count(), columns.count());
  std::vector<int> sources;
  for (std::int64_t x = columns.begin; x < columns.end; ++x)
    sources.push_back(wrapped(x, picture.cols, wrap_[0]));
  for (int y = 0; y < out.pixels.rows; ++y) {
    const int from = picture.rows - 1 - wrapped(rows.end - 1 - y, picture.rows, wrap_[1]);
    for (int x = 0; x < out.pixels.cols; ++x)
      out.pixels(y, x) = picture(from, sources[static_cast<std::size_t>(x)]);
  }
  out.low = {static_cast<double>(columns.begin) / picture.cols,
             static_cast<double>(rows.begin) / picture.rows};
  out.size = {static_cast<double>(columns.count()) / picture.cols,
              static_cast<double>(rows.count()) / picture.rows};
  return out;
}

}  // namespace hypotrack::internal
