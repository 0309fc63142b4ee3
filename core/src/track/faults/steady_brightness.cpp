#include "track/faults/steady_brightness.hpp"

#include <algorithm>
#include <cmath>

namespace hypotrack::internal {

void SteadyBrightness::next(std::span<const float> jumps) {
  constexpr float kAlmost = 0.1F;  // colours follow the rest
  gains_.resize(jumps.size(), 1);
  for (std::size_t v = 0; v < jumps.size(); ++v) {
    gains_[v] *= jumps[v];
    if (std::abs(gains_[v] - 1) < kAlmost) gains_[v] = 1;
  }
}

Frame SteadyBrightness::applied_to(const Frame& frame) const {
  Frame out = frame;
  for (std::size_t v = 0; v < std::min(gains_.size(), out.views.size()); ++v) {
    if (gains_[v] == 1 || out.views[v].color.empty()) continue;
    cv::Mat steady;  // the source keeps its picture
    out.views[v].color.convertTo(steady, -1, 1 / gains_[v]);
    out.views[v].color = steady;
  }
  return out;
}

}  // namespace hypotrack::internal
