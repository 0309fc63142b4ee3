#include "track/faults/view_order.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/core/hal/intrin.hpp>

#include "hypotrack/api/camera.hpp"

namespace hypotrack::internal {
namespace {

// Places are compared by patches of kPatchWidth x kPatchHeight cells.
constexpr int kPatchWidth = 8, kPatchHeight = 4;

/// Returns the cells as bytes with a mean of 128 and a standard deviation of 32: exposures may
/// differ.
cv::Mat1b normalized(const SmallPicture& picture) {
  constexpr double kMean = 128, kDeviation = 32, kLeast = 0.5 * SmallPicture::kLevel;
  const cv::Mat1w cells(picture.height, picture.width,
                        const_cast<std::uint16_t*>(picture.cells.data()));
  cv::Scalar mean, deviation;
  cv::meanStdDev(cells, mean, deviation);
  const double gain = kDeviation / std::max(deviation[0], kLeast);
  cv::Mat1b out;
  cells.convertTo(out, CV_8U, gain, kMean - gain * mean[0]);
  return out;
}

/// A patch, given its top left cell.
struct Patch {
  Patch(const std::uint8_t* cell, std::ptrdiff_t stride)
      : top(cv::v_load_halves(cell, cell + stride)),
        bottom(cv::v_load_halves(cell + 2 * stride, cell + 3 * stride)) {}
  cv::v_uint8x16 top, bottom;
};

/// Returns the sum of absolute differences of two patches.
unsigned difference(const Patch& a, const Patch& b) {
  return cv::v_reduce_sad(a.top, b.top) + cv::v_reduce_sad(a.bottom, b.bottom);
}

}  // namespace

std::vector<std::array<ViewOrder::Cell, 2>> ViewOrder::line(const Camera& from, const Camera& to,
                                                            const Eigen::Vector3d& ray,
                                                            const SmallPicture& size) const {
  std::vector<std::array<Cell, 2>> out;
  const Eigen::Isometry3d to_from = to.camera_from_world * from.camera_from_world.inverse();
  for (int k = 0; k < depths_; ++k) {
    // A point at inverse depth q is to_from * ray / q, in the same direction as
    // this one.
    const double q = nearest_ * k / (depths_ - 1);
    const Eigen::Vector3d point = to_from.linear() * ray + q * to_from.translation();
    const Eigen::Vector2d pixel = project(to, to.camera_from_world.inverse() * point);
    const double x = std::round((pixel.x() + 0.5) / size.cell - 0.5 * kPatchWidth);
    const double y = std::round((pixel.y() + 0.5) / size.cell - 0.5 * kPatchHeight);
    const bool inside = x >= 0 && y >= 0 && x <= size.width - kPatchWidth &&
                        y <= size.height - kPatchHeight;  // false for NaN
    if (!inside) break;
    out.push_back({static_cast<Cell>(x), static_cast<Cell>(y)});
  }
  return out;
}

void ViewOrder::prepare(const SmallPicture& size) {
  constexpr double kSameWay = 0.9;       // cosine of the angle between the axes: 25 degrees
  constexpr double kNearest = 0.25;      // m
  constexpr double kLongest = 48;        // cells of a line
  constexpr int kAcross = 6, kDown = 4;  // cells from place to place
  constexpr int kFewest = 8;             // steps of a place
  prepared_ = true;
  width_ = size.width;
  height_ = size.height;
  const Camera& first = cameras_[0];
  const Camera& second = cameras_[1];
  const Eigen::Isometry3d second_from_first =
      second.camera_from_world * first.camera_from_world.inverse();
  const double baseline = second_from_first.translation().norm();
  if (first.width != second.width || first.height != second.height) return;
  if (second_from_first.linear()(2, 2) < kSameWay || baseline <= 0) return;
  const double cells_per_metre = first.fx * baseline / size.cell;  // by inverse depth
  const double longest = std::min(cells_per_metre / kNearest, kLongest);
  nearest_ = longest / cells_per_metre;
  depths_ = static_cast<int>(std::ceil(longest)) + 1;
  if (depths_ < kFewest) return;
  std::vector<std::array<Cell, 2>> corners;
  for (int y = 0; y + kPatchHeight <= size.height; y += kDown)
    for (int x = 0; x + kPatchWidth <= size.width; x += kAcross)
      corners.push_back({static_cast<Cell>(x), static_cast<Cell>(y)});
  Eigen::Matrix2Xd pixels(2, std::ssize(corners));
  for (std::size_t i = 0; i < corners.size(); ++i)
    pixels.col(static_cast<Eigen::Index>(i))
        << size.cell * (corners[i][0] + 0.5 * kPatchWidth) - 0.5,
        size.cell * (corners[i][1] + 0.5 * kPatchHeight) - 0.5;
  const Eigen::Matrix3Xd rays = back_project(first, pixels);
  const Eigen::Matrix3Xd exchanged_rays = back_project(second, pixels);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    const auto right = line(first, second, rays.col(column), size);
    const auto exchanged = line(second, first, exchanged_rays.col(column), size);
    const std::size_t steps = std::min(right.size(), exchanged.size());
    if (steps < kFewest) continue;
    places_.push_back({corners[i][0], corners[i][1], static_cast<int>(steps), steps_.size()});
    for (std::size_t k = 0; k < steps; ++k) steps_.push_back({right[k], exchanged[k]});
  }
}

bool ViewOrder::is_exchanged(const SmallPicture& first, const SmallPicture& second) {
  constexpr unsigned kTexture = 8 * kPatchWidth * kPatchHeight;  // least difference to beside
  constexpr unsigned kNoise = 2 * kPatchWidth * kPatchHeight;
  constexpr int kBeside = 2, kNotFar = 3;  // cells
  constexpr std::size_t kEnough = 240;     // places with texture
  constexpr std::size_t kFewest = 20, kTimes = 4;
  if (first.width != second.width || first.height != second.height) return false;
  if (!prepared_) prepare(first);
  if (first.width != width_ || first.height != height_) return false;
  const cv::Mat1b a = normalized(first), b = normalized(second);
  std::vector<const Place*> textured;
  for (const Place& place : places_) {
    const std::uint8_t* cell = a.ptr(place.y) + place.x;
    const int beside = place.x >= kBeside ? -kBeside : kBeside;
    if (difference({cell, width_}, {cell + beside, width_}) >= kTexture) textured.push_back(&place);
  }
  const std::size_t every = 1 + textured.size() / kEnough;
  std::size_t for_right = 0, for_exchanged = 0;  // places that match one order clearly better
  for (std::size_t i = 0; i < textured.size(); i += every) {
    const std::size_t left = (textured.size() - i + every - 1) / every;
    if (for_exchanged + left < std::max(kFewest, kTimes * for_right)) return false;
    const Place& place = *textured[i];
    const Patch patch(a.ptr(place.y) + place.x, width_);
    unsigned right = std::numeric_limits<int>::max(), exchanged = right;
    int exchanged_step = 0;
    for (int k = 0; k < place.steps; ++k) {
      const Step& step = steps_[place.first_step + static_cast<std::size_t>(k)];
      const auto at = [&](const std::array<Cell, 2>& cell) {
        return difference(patch, {b.ptr(cell[1]) + cell[0], width_});
      };
      right = std::min(right, at(step.right));
      const unsigned other = at(step.exchanged);
      if (other >= exchanged) continue;
      exchanged = other;
      exchanged_step = k;
    }
    // The better match must be clear. Far places are on the wrong side if the calibration is a
    // little off.
    for_right += 2 * (right + kNoise) < exchanged + kNoise;
    for_exchanged += exchanged_step >= kNotFar && 2 * (exchanged + kNoise) < right + kNoise;
  }
  return for_exchanged >= std::max(kFewest, kTimes * for_right);
}

}  // namespace hypotrack::internal
