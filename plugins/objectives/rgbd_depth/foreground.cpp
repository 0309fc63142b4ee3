#include "foreground.hpp"

namespace hypotrack::rgbd_depth {
namespace {

/// A row of the images that a rule uses; null for the others.
struct ViewRow {
  const std::uint8_t* valid;
  const std::uint8_t* mask;
  const float* depth;
  const std::uint8_t* color;

  ViewRow(const TileView& view, Rule rule, int y)
      : valid(view.valid.ptr(y)),
        mask(rule == Rule::mask ? view.mask.ptr(y) : nullptr),
        depth(view.depth.ptr<float>(y)),
        color(rule == Rule::skin ? view.color.ptr(y) : nullptr) {}

  ViewedPixel at(int x) const {
    ViewedPixel pixel{valid[x] != 0, mask && mask[x] != 0, depth[x], 0, 0, 0};
    if (!color) return pixel;
    const std::uint8_t* bgr = color + 3 * x;
    pixel.blue = bgr[0];
    pixel.green = bgr[1];
    pixel.red = bgr[2];
    return pixel;
  }
};

}  // namespace

ObservedView observe(const TileView& view, Foreground foreground, const DepthRange& range) {
  const Rule rule = rule_of(foreground, !view.mask.empty());
  ObservedView out;
  out.pixels.resize(view.depth.cols, view.depth.rows);
  for (int y = 0; y < view.depth.rows; ++y) {
    const ViewRow row(view, rule, y);
    float* observed = out.pixels.row(y);
    for (int x = 0; x < view.depth.cols; ++x) {
      observed[x] = observed_at(row.at(x), rule, range);
      out.measured += observed[x] > 0.0f;
      out.foreground += observed[x] > 0.0f || observed[x] == kUnmeasured;
    }
  }
  return out;
}

}  // namespace hypotrack::rgbd_depth
