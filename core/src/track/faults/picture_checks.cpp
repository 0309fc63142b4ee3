#include "track/faults/picture_checks.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <utility>

namespace hypotrack::internal {
namespace {

/// Returns whether two pictures differ far less from each other than each does from itself a cell
/// aside. Pictures without texture may be those of two cameras.
bool is_same(const SmallPicture& a, const SmallPicture& b) {
  constexpr int kRowStep = 3;
  constexpr std::int64_t kTimes = 20;
  constexpr std::int64_t kTextured = SmallPicture::kLevel;  // mean difference a cell aside
  if (a.width != b.width || a.height != b.height) return false;
  std::int64_t between = 0, beside = 0, count = 0;
  for (int y = 0; y < a.height; y += kRowStep) {
    const std::uint16_t* one = a.row(y);
    const std::uint16_t* other = b.row(y);
    for (int x = 1; x < a.width; ++x) {
      between += std::abs(one[x] - other[x]);
      beside += std::abs(one[x] - one[x - 1]);
    }
    count += a.width - 1;
  }
  return beside >= kTextured * count && beside >= kTimes * between;
}

/// Returns by how much a picture is brighter than the one before, if most of its cells are far
/// brighter or darker; otherwise 1. `gain` is gain_between() of the pictures.
float jump_between(const SmallPicture& before, const SmallPicture& now, float gain) {
  constexpr double kMean = 1.5;
  constexpr float kMost = 1.4F;
  const double ratio = (now.mean + 1) / (before.mean + 1);
  if (ratio < kMean && ratio > 1 / kMean) return 1;
  return gain > kMost || gain < 1 / kMost ? gain : 1;
}

bool is_measured(const cv::Mat& depth) {
  for (int y = 0; y < depth.rows; ++y) {
    const float* row = depth.ptr<float>(y);
    if (std::any_of(row, row + depth.cols, [](float metres) { return metres > 0; })) return true;
  }
  return false;
}

/// Returns the first view whose depth is nowhere measured.
std::optional<int> unmeasured_view(const Frame& frame) {
  for (std::size_t v = 0; v < frame.views.size(); ++v) {
    const cv::Mat& depth = frame.views[v].depth;
    if (depth.type() == CV_32FC1 && !depth.empty() && !is_measured(depth))
      return static_cast<int>(v);
  }
  return std::nullopt;
}

}  // namespace

PictureChecks::PictureChecks(std::vector<Camera> cameras, bool with_depth)
    : with_depth_(with_depth), frozen_(cameras) {
  if (cameras.size() > 1) order_.emplace(cameras[0], cameras[1]);
}

ViewFault PictureChecks::check(const Frame& frame) {
  SmallPictures now(frame.views.size());
  tbb::parallel_for(std::size_t{0}, now.size(), [&](std::size_t v) {
    const View& view = frame.views[v];
    if (!view.color.empty() && view.depth.empty() && view.color.type() == CV_8UC3)
      now[v] = std::make_shared<const SmallPicture>(shrink(view.color));
  });
  jumps_.assign(now.size(), 1);
  drifts_ = jumps_;
  ViewFault found = find(now);
  if (const auto view = with_depth_ ? unmeasured_view(frame) : std::nullopt)
    found = {FrameFault::black, *view};
  if (!spoils_pictures(found.fault)) good_ = std::move(now);
  return found;
}

ViewFault PictureChecks::find(const SmallPictures& now) {
  if (const auto view = empty_view(now, &SmallPicture::black)) return {FrameFault::black, *view};
  if (const auto view = empty_view(now, &SmallPicture::white))
    return {FrameFault::saturated, *view};
  if (order_ && now.size() > 1 && now[0] && now[1]) {
    if (is_same(*now[0], *now[1])) return {FrameFault::same_picture, 1};
    if (order_->is_exchanged(*now[0], *now[1])) return {FrameFault::exchanged, 0};
  }
  if (const auto frozen = frozen_.next(now)) return {FrameFault::frozen, *frozen};
  if (const auto view = jumping_view(now)) return {FrameFault::brightness, *view};
  return {};
}

std::optional<int> PictureChecks::empty_view(const SmallPictures& now,
                                             double SmallPicture::*share) const {
  constexpr double kAll = 0.98, kMost = 0.5;
  for (std::size_t v = 0; v < now.size(); ++v) {
    if (!now[v] || (*now[v]).*share < kAll) continue;
    // A black or white background may be all there is when the models leave.
    const bool was_empty = v < good_.size() && good_[v] && (*good_[v]).*share > kMost;
    if (!was_empty) return static_cast<int>(v);
  }
  return std::nullopt;
}

std::optional<int> PictureChecks::jumping_view(const SmallPictures& now) {
  std::optional<int> first;
  for (std::size_t v = 0; v < std::min(now.size(), good_.size()); ++v) {
    if (!now[v] || !good_[v] || now[v]->cells.size() != good_[v]->cells.size()) continue;
    const float gain = frozen_.gain(v, good_[v], now[v]);
    jumps_[v] = jump_between(*good_[v], *now[v], gain);
    if (jumps_[v] == 1) drifts_[v] = gain;
    if (jumps_[v] != 1 && !first) first = static_cast<int>(v);
  }
  return first;
}

}  // namespace hypotrack::internal
