#include "foreground.hpp"

#include "hypotrack/plugin/pixel.hpp"
#include "rule.hpp"

namespace hypotrack::skin {
namespace {

/// Fills in P from a function of the pixel, probability(x, y).
template <class Probability>
ViewForeground fill(const TileView& view, Probability probability) {
  ViewForeground out;
  out.pixels.resize(view.camera.width, view.camera.height);
  for (int y = 0; y < out.pixels.height(); ++y) {
    const auto* valid = view.valid.ptr(y);
    std::uint32_t* row = out.pixels.row(y);
    for (int x = 0; x < out.pixels.width(); ++x) {
      if (!valid[x]) continue;
      const float p = probability(x, y);
      row[x] = pack_unorm16(p, 1 - p);
      out.sum += double{p};
    }
  }
  return out;
}

float squared_distance(const cv::Vec3b& a, const cv::Vec4b& b) {
  float sum = 0;
  for (int i = 0; i < 3; ++i) {
    const auto apart = static_cast<float>(a[i] - b[i]);
    sum += apart * apart;
  }
  return sum;
}

}  // namespace

ViewForeground ForegroundEstimator::estimate(const Observation& observation, std::size_t index) {
  const TileView& view = observation.views[index];
  switch (
      rule_of(settings_.foreground, !view.color.empty(), !view.mask.empty(), !view.depth.empty())) {
    case Rule::mask:
      return fill(view, [&](int x, int y) { return view.mask.at<uchar>(y, x) ? 1.0f : 0.0f; });
    case Rule::depth: {
      const DepthRange range = depth_range(observation, view.camera, settings_.range);
      return fill(view, [&](int x, int y) {
        const float z = view.depth.at<float>(y, x);
        return z > 0 && z >= range.nearest && z <= range.farthest ? 1.0f : 0.0f;
      });
    }
    case Rule::color:
      if (colors_.wants(observation)) {
        colors_.learn(observation, view.camera, view.color, view.valid);
      }
      return fill(view, [&](int x, int y) {
        const auto& p = view.color.at<cv::Vec3b>(y, x);
        const auto bin = static_cast<std::size_t>(bin_of(p[0], p[1], p[2]));
        if (view.background.empty()) return colors_.probabilities()[bin];
        const auto& b = view.background.at<cv::Vec4b>(y, x);
        if (b[3] == 0) return colors_.probabilities()[bin];
        return foreground_before(colors_.frequencies()[bin], squared_distance(p, b));
      });
    case Rule::none:
      break;
  }
  return {};
}

}  // namespace hypotrack::skin
