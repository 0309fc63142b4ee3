#include "track/occlude/occluder_finder.hpp"

#include <algorithm>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "cost/draw/hypothesis_drawer.hpp"
#include "tile/tiles.hpp"

namespace hypotrack::internal {
namespace {

constexpr TileSettings kMatchedTile{128, 0.6};
constexpr double kMostNearer = 0.7;  // share of the model's disparity that an occluder has more
constexpr double kBefore = 1.3;      // pixels of disparity by which an occluder is nearer
constexpr float kUnlike = 0.4f;  // foreground probability below which a pixel is not the model's
constexpr double kLeastHidden = 0.02;  // share of the model's pixels
constexpr double kLarge = 0.2;         // the same, of what has the model's colours
constexpr int kGrowth = 21;            // pixels, twice what a region grows
constexpr int kBeside = 13;            // pixels, twice the band that edges are sought in
constexpr int kReach = 25;             // pixels, twice what a model moves
constexpr int kSteps = 16;             // of the matcher's disparities, per pixel
constexpr int kSmooth = 5;  // change of a channel between pixels of one surface, 0 .. 255

cv::Mat1f inverse_depths(const DepthTile& tile) {
  cv::Mat1f out(tile.height, tile.width, 0.0f);
  for (int y = std::max(tile.y0, 0); y < std::min(tile.y1, tile.height); ++y)
    std::copy_n(tile.inverse_depth + static_cast<std::ptrdiff_t>(y) * tile.stride, tile.width,
                out.ptr<float>(y));
  return out;
}

/// Disparity of a rectified pair of tiles: scale / z + offset, in pixels.
struct Disparity {
  double scale, offset;

  static Disparity of(const TileCamera& first, const TileCamera& second) {
    const Eigen::Vector3d center =
        first.camera_from_world * second.camera_from_world.inverse().translation();
    return {first.fx * center.x(), first.cx - second.cx};
  }
};

/// Matches a pair of tiles. `nearest` is 1/z of the model's nearest point. Pixels without a match
/// get the least disparity.
cv::Mat1f disparities(const Observation& seen, const Disparity& of, double nearest) {
  const double model = of.scale * nearest, middle = model + of.offset;
  const int last = cvCeil(middle + kMostNearer * model);
  const int count = std::min((cvCeil(last - middle + model) / 16 + 1) * 16, 128);
  const int least = last - count + 1;
  const auto matcher = cv::StereoSGBM::create(least, count, 3, 8 * 27, 32 * 27, 2, 31, 0, 0, 0,
                                              cv::StereoSGBM::MODE_SGBM);
  // The matcher skips columns that some disparity takes out of the other picture.
  const int left = std::max(last, 0), right = std::max(-least, 0);
  cv::Mat first, second, steps;
  cv::copyMakeBorder(seen.views[0].color, first, 0, 0, left, right, cv::BORDER_REPLICATE);
  cv::copyMakeBorder(seen.views[1].color, second, 0, 0, left, right, cv::BORDER_REPLICATE);
  matcher->compute(first, second, steps);
  cv::Mat1f out;
  steps.colRange(left, steps.cols - right).convertTo(out, CV_32F, 1.0 / kSteps);
  return out;
}

/// Returns for every pixel the depth of the nearest one that is drawn.
cv::Mat1f extended(const cv::Mat1f& drawn) {
  cv::Mat1b outside = drawn == 0;
  cv::Mat distance;
  cv::Mat1i label;
  cv::distanceTransform(outside, distance, label, cv::DIST_L2, cv::DIST_MASK_5,
                        cv::DIST_LABEL_PIXEL);
  std::vector<float> of_label(drawn.total() + 1, 0.0f);
  for (int y = 0; y < drawn.rows; ++y)
    for (int x = 0; x < drawn.cols; ++x)
      if (drawn(y, x) > 0) of_label[static_cast<std::size_t>(label(y, x))] = drawn(y, x);
  cv::Mat1f out(drawn.size());
  for (int y = 0; y < drawn.rows; ++y)
    for (int x = 0; x < drawn.cols; ++x)
      out(y, x) = of_label[static_cast<std::size_t>(label(y, x))];
  return out;
}

/// Marks pixels that have other colours than the model.
cv::Mat1b unlike_model(const cv::Mat3b& color, const ForegroundColors& foreground) {
  cv::Mat1b out(color.size(), uchar{0});
  for (int y = 0; y < color.rows; ++y)
    for (int x = 0; x < color.cols; ++x)
      if (foreground.probability(color(y, x)) < kUnlike) out(y, x) = 255;
  return out;
}

/// Returns the regions about the seeds in which colours change smoothly. `unlike` bounds them.
cv::Mat1b grown(cv::Mat3b color, const cv::Mat1b& unlike, const cv::Mat1b& seeds) {
  cv::Mat1b done(color.rows + 2, color.cols + 2, uchar{1});
  cv::Mat1b inner = done(cv::Rect(1, 1, color.cols, color.rows));
  inner.setTo(0, unlike);
  constexpr int kFlags = 4 | cv::FLOODFILL_MASK_ONLY | (255 << 8);
  for (int y = 0; y < color.rows; ++y)
    for (int x = 0; x < color.cols; ++x)
      if (seeds(y, x) && !inner(y, x))
        cv::floodFill(color, done, {x, y}, {}, nullptr, cv::Scalar::all(kSmooth),
                      cv::Scalar::all(kSmooth), kFlags);
  cv::Mat1b near, out;
  cv::dilate(seeds, near, cv::Mat1b::ones(kGrowth, kGrowth));
  cv::dilate(((inner == 255) & near) | seeds, out, cv::Mat1b::ones(3, 3));
  return out;
}

/// Returns the connected regions of `near` that hide the model: they have other colours over some
/// of it, or reach much farther than it may have moved. `own` marks the model.
cv::Mat1b hiding(const cv::Mat1b& near, const cv::Mat1b& unlike, const cv::Mat1b& own) {
  cv::Mat1b beyond, about;
  cv::dilate(own, about, cv::getStructuringElement(cv::MORPH_ELLIPSE, {kBeside, kBeside}));
  cv::dilate(own, beyond, cv::getStructuringElement(cv::MORPH_ELLIPSE, {kReach, kReach}));
  cv::Mat1i label;
  const auto count = static_cast<std::size_t>(cv::connectedComponents(near, label, 4));
  std::vector<int> over(count, 0), strange(count, 0), outside(count, 0);
  for (int y = 0; y < near.rows; ++y)
    for (int x = 0; x < near.cols; ++x) {
      const auto i = static_cast<std::size_t>(label(y, x));
      over[i] += about(y, x) != 0;
      strange[i] += own(y, x) != 0 && unlike(y, x) != 0;
      outside[i] += beyond(y, x) == 0;
    }
  const int size = cv::countNonZero(own);
  cv::Mat1b out(near.size(), uchar{0});
  for (int y = 0; y < near.rows; ++y)
    for (int x = 0; x < near.cols; ++x) {
      const auto i = static_cast<std::size_t>(label(y, x));
      const bool hides = i > 0 && (strange[i] > kLeastHidden * size ||
                                   (over[i] > kLeastHidden * size && outside[i] > kLarge * size));
      if (hides) out(y, x) = 255;
    }
  return out;
}

/// Moves pixels of the first view to the second, by their disparity.
cv::Mat1b moved(const cv::Mat1b& pixels, const cv::Mat1f& disparity) {
  cv::Mat1b out(pixels.size(), uchar{0});
  for (int y = 0; y < out.rows; ++y)
    for (int x = 0; x < out.cols; ++x) {
      if (!pixels(y, x)) continue;
      const int to = cvRound(static_cast<float>(x) - disparity(y, x));
      if (to >= 0 && to < out.cols) out(y, to) = 255;
    }
  return out;
}

}  // namespace

struct OccluderFinder::Impl {
  Impl(const Scene& whole, std::size_t model, const std::vector<Camera>& cameras)
      : scene(whole),
        item(whole.items()[model]),
        single(std::vector{std::pair{item.name, item.model}}),
        tiles(single, cameras, kMatchedTile),
        plan(whole),
        drawer(plan),
        single_plan(single),
        single_drawer(single_plan) {}

  std::array<cv::Mat1b, 2> hidden(const Observation& seen, const cv::Mat1f& own,
                                  const cv::Mat1f& all, const ForegroundColors& foreground) const;

  const Scene& scene;
  const Scene::Item& item;
  Scene single;
  TileMaker tiles;
  ScenePlan plan;
  HypothesisDrawer drawer;
  ScenePlan single_plan;
  HypothesisDrawer single_drawer;
};

OccluderFinder::OccluderFinder(const Scene& scene, std::size_t model,
                               const std::vector<Camera>& cameras)
    : impl_(std::make_unique<Impl>(scene, model, cameras)) {}
OccluderFinder::~OccluderFinder() = default;
OccluderFinder::OccluderFinder(OccluderFinder&&) noexcept = default;

/// Finds what is nearer than the scene where the model should be, and has other colours. Grows it,
/// because a plain surface shows its depth only at its edges. The masks are empty if nothing is.
std::array<cv::Mat1b, 2> OccluderFinder::Impl::hidden(const Observation& seen, const cv::Mat1f& own,
                                                      const cv::Mat1f& all,
                                                      const ForegroundColors& foreground) const {
  const Disparity of = Disparity::of(seen.views[0].camera, seen.views[1].camera);
  if (!(of.scale > 0)) return {};  // the first camera is the right one
  double nearest = 0;              // 1/z
  cv::minMaxLoc(own, nullptr, &nearest);
  const cv::Mat1f disparity = disparities(seen, of, nearest);
  const cv::Mat1f limit = of.scale * extended(all) + of.offset + kBefore;
  const cv::Mat3b first = seen.views[0].color, second = seen.views[1].color;
  const cv::Mat1b unlike = unlike_model(first, foreground);
  cv::Mat1b near = disparity > limit;
  cv::morphologyEx(near, near, cv::MORPH_OPEN, cv::Mat1b::ones(3, 3));
  const cv::Mat1b found = hiding(near, unlike, own > 0);
  if (cv::countNonZero(found) == 0) return {};
  // A plain surface has its depth at its edges only.
  cv::Mat1b at_least = disparity > limit - kBefore;
  cv::morphologyEx(at_least, at_least, cv::MORPH_CLOSE, cv::Mat1b::ones(9, 9));
  return {grown(first, unlike & at_least, found),
          grown(second, unlike_model(second, foreground), moved(found, disparity))};
}

std::optional<std::array<HiddenPart, 2>> OccluderFinder::find(const Frame& frame,
                                                              const Eigen::VectorXd& state,
                                                              const ColorMap& colors,
                                                              const ForegroundColors& foreground) {
  Impl& self = *impl_;
  if (!self.tiles.rectifies() || !foreground.known()) return std::nullopt;
  if (frame.views[0].color.empty() || frame.views[1].color.empty()) return std::nullopt;
  const Eigen::VectorXd own = state.segment(self.item.offset, self.item.model->dimension());
  if (self.tiles.visible_share(own) == 0) return std::nullopt;
  TilePlan plan = self.tiles.plan(frame, own);
  plan.views[1].colors = colors;
  const Observation seen = self.tiles.resample(frame, plan);
  const FrameProjection projection(plan.header);
  self.drawer.prepare(projection);
  self.single_drawer.prepare(projection);
  const auto span = [](const Eigen::VectorXd& v) {
    return std::span<const double>(v.data(), static_cast<std::size_t>(v.size()));
  };
  const cv::Mat1f mine = inverse_depths(self.single_drawer.draw(span(own))[0]);
  const cv::Mat1f all = inverse_depths(self.drawer.draw(span(state))[0]);
  const std::array<cv::Mat1b, 2> hidden = self.hidden(seen, mine, all, foreground);
  if (hidden[0].empty()) return std::nullopt;
  return std::array{HiddenPart{seen.views[0].camera, hidden[0]},
                    HiddenPart{seen.views[1].camera, hidden[1]}};
}

}  // namespace hypotrack::internal
