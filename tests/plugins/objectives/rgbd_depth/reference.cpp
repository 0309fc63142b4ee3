#include "reference.hpp"

#include <algorithm>
#include <cmath>

namespace hypotrack::rgbd_depth::reference {

double cost(const Observation& observation, const RenderedHypothesis& hypothesis,
            const Params& params) {
  double differences = 0, intersection = 0, either = 0;
  for (std::size_t i = 0; i < observation.views.size(); ++i) {
    const TileView& view = observation.views[i];
    const DepthTile& tile = hypothesis.views[i];
    for (int y = 0; y < tile.height; ++y) {
      for (int x = 0; x < tile.width; ++x) {
        if (!view.valid.at<uchar>(y, x)) continue;
        const bool o_s = view.mask.at<uchar>(y, x) != 0;
        const double o_d = o_s ? double{view.depth.at<float>(y, x)} : 0;
        const double w = tile.inverse_depth[y * tile.stride + x];
        const double r_d = w > 0 ? 1 / w : 0;
        const bool hole = o_s && o_d == 0;
        if (!hole) differences += std::min(std::abs(o_d - r_d), params.d_max);
        const bool r_m = r_d > 0 && (o_d == 0 || std::abs(o_d - r_d) <= params.d_match);
        intersection += o_s && r_m;
        either += o_s || r_m;
      }
    }
  }
  const double s = intersection + either > 0 ? 1 - 2 * intersection / (intersection + either) : 1;
  return 100 * differences / (either + 1e-6) + params.lambda * s;
}

}  // namespace hypotrack::rgbd_depth::reference
