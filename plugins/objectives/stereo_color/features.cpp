#include "features.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "color-inl.hpp"
#include "distinctiveness.hpp"

namespace hypotrack::stereo_color {
namespace {

Bgr to_bgr(const cv::Vec3b& p) { return {p[0], p[1], p[2]}; }
cv::Vec3f to_vec(const Channels& c) { return {c.c0, c.c1, c.c2}; }

// Converts the tile to a colour space, 32-bit float, channels in 0..1.
cv::Mat3f convert(const cv::Mat3b& bgr, const Params& params) {
  const ColorSpace space = params.color_space;
  cv::Mat3f out(bgr.size());
  if (space == ColorSpace::rgb) {
    const auto share = static_cast<float>(params.gray_weight);
    std::transform(bgr.begin(), bgr.end(), out.begin(), [share](const cv::Vec3b& p) {
      return to_vec(with_gray_share(rgb_channels(to_bgr(p)), share));
    });
  } else if (space == ColorSpace::gray) {
    std::transform(bgr.begin(), bgr.end(), out.begin(),
                   [](const cv::Vec3b& p) { return cv::Vec3f(gray_level(to_bgr(p)), 0.0f, 0.0f); });
  } else {
    cv::Mat3f scaled;
    bgr.convertTo(scaled, CV_32F, 1.0 / 255.0);
    const bool lab = space == ColorSpace::lab;
    cv::cvtColor(scaled, out, lab ? cv::COLOR_BGR2Lab : cv::COLOR_BGR2HSV);
    std::transform(out.begin(), out.end(), out.begin(), [lab](const cv::Vec3f& p) {
      return to_vec(lab ? lab_channels(p[0], p[1], p[2]) : on_cone({p[0], p[1], p[2]}));
    });
  }
  return out;
}

std::vector<std::uint8_t> to_vector(const cv::Mat1b& image) {
  std::vector<std::uint8_t> out;
  out.reserve(image.total());
  for (int y = 0; y < image.rows; ++y) out.insert(out.end(), image[y], image[y] + image.cols);
  return out;
}

std::vector<float> weights(const TileView& view, const Params& params) {
  const cv::Mat3b bgr = view.color;
  const std::vector<std::uint8_t> valid = to_vector(view.valid);
  std::vector<float> c(valid.size(), 1.0f);
  if (params.distinctiveness != Distinctiveness::none) {
    std::vector<float> grey(valid.size());
    std::transform(bgr.begin(), bgr.end(), grey.begin(),
                   [](const cv::Vec3b& p) { return gray_level(to_bgr(p)); });
    c = distinctiveness(principal_curvatures(grey, valid, bgr.cols, bgr.rows), valid, params.w_t);
  }
  const bool masked = params.use_mask && !view.mask.empty();
  for (std::size_t i = 0; i < c.size(); ++i) c[i] = valid[i] ? c[i] : 0.0f;
  if (!masked) return c;
  const std::vector<std::uint8_t> kept = to_vector(view.mask);
  for (std::size_t i = 0; i < c.size(); ++i) c[i] = kept[i] ? c[i] : 0.0f;
  return c;
}

/// Packs colours that no conversion changes: as pack_unorm16() does with a 255th of each.
void pack_bytes(const cv::Mat3b& bgr, const std::vector<float>& weights, Features& out) {
  constexpr std::uint32_t kUnit = 65535 / 255;
  for (int y = 0; y < bgr.rows; ++y) {
    const cv::Vec3b* color = bgr[y];
    const float* weight = weights.data() + static_cast<std::ptrdiff_t>(y) * bgr.cols;
    std::uint32_t* first = out.channels_01.row(y);
    std::uint32_t* rest = out.channel_2_weight.row(y);
    for (int x = 0; x < bgr.cols; ++x) {
      const std::uint32_t blue = color[x][0], green = color[x][1], red = color[x][2];
      first[x] = kUnit * (red | green << 16);
      rest[x] = kUnit * blue | pack_unorm16(0, weight[x]);
    }
  }
}

}  // namespace

Features make_features(const TileView& view, const Params& params) {
  const std::vector<float> c = weights(view, params);
  Features out;
  out.channels_01.resize(view.color.cols, view.color.rows);
  out.channel_2_weight.resize(view.color.cols, view.color.rows);
  if (params.color_space == ColorSpace::rgb && params.gray_weight == 1) {
    pack_bytes(view.color, c, out);
    return out;
  }
  const cv::Mat3f color = convert(view.color, params);
  for (int y = 0; y < color.rows; ++y) {
    const float* weight = c.data() + static_cast<std::ptrdiff_t>(y) * color.cols;
    for (int x = 0; x < color.cols; ++x) {
      const cv::Vec3f& p = color(y, x);
      out.channels_01.row(y)[x] = pack_unorm16(p[0], p[1]);
      out.channel_2_weight.row(y)[x] = pack_unorm16(p[2], weight[x]);
    }
  }
  return out;
}

std::vector<LabNode> lab_nodes() {
  cv::Mat3f colors(kLabNodes * kLabNodes, kLabNodes);
  for (int i = 0; i < kLabNodeCount; ++i) {
    const int r = i / (kLabNodes * kLabNodes), g = i / kLabNodes % kLabNodes, b = i % kLabNodes;
    colors(i / kLabNodes, b) = cv::Vec3f(cv::Vec3i(b, g, r)) / (kLabNodes - 1.0f);
  }
  cv::Mat3f lab;
  cv::cvtColor(colors, lab, cv::COLOR_BGR2Lab);
  const auto units = [](float x) { return static_cast<std::int16_t>(std::lround(x / kLabUnit)); };
  std::vector<LabNode> nodes(kLabNodeCount);
  std::transform(lab.begin(), lab.end(), nodes.begin(), [&](const cv::Vec3f& p) {
    return LabNode{units(p[0] / 100.0f), units((p[1] + 128.0f) / 256.0f),
                   units((p[2] + 128.0f) / 256.0f), 0};
  });
  return nodes;
}

}  // namespace hypotrack::stereo_color
