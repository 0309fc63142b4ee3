#include "foreground.hpp"

#include <algorithm>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "hypotrack/kinematics.hpp"
#include "hypotrack/unorm16.hpp"
#include "silhouette.hpp"

namespace hypotrack::skin {
namespace {

/// Depths z along a camera's axis, metres.
struct DepthRange {
  float nearest, farthest;
};

DepthRange range_around(const Observation& observation, const TileCamera& camera, double margin) {
  const Eigen::Isometry3f view = camera.camera_from_world.cast<float>();
  float nearest = std::numeric_limits<float>::infinity(), farthest = 0;
  for (const Scene::Item& item : observation.scene->items()) {
    const Eigen::Matrix3Xf vertices =
        posed_vertices(*item.model, observation.scene->part(item, observation.start));
    const Eigen::RowVectorXf z = (view.linear().row(2) * vertices).array() + view.translation().z();
    nearest = std::min(nearest, z.minCoeff());
    farthest = std::max(farthest, z.maxCoeff());
  }
  return {nearest - static_cast<float>(margin), farthest + static_cast<float>(margin)};
}

/// How likely each pixel is foreground by its place: 1/2 on the silhouette's edge and rising to its
/// inside over as many pixels as the pose may be wrong by. Negative where the image is invalid.
cv::Mat1f place_prior(const cv::Mat1b& silhouette, const cv::Mat1b& valid, double pose_error) {
  cv::Mat1f inside, outside;
  cv::distanceTransform(silhouette, inside, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  cv::distanceTransform(silhouette == 0, outside, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  cv::Mat1f out;
  cv::exp((outside - inside) / pose_error, out);
  out = 1 / (1 + out);
  out.setTo(-1, valid == 0);
  return out;
}

/// Pixels per metre at the middle of the scene.
double scale_at(const Observation& observation, const TileCamera& camera) {
  const DepthRange range = range_around(observation, camera, 0);
  const float middle = std::max((range.nearest + range.farthest) / 2, 0.01f);
  return camera.fx / double{middle};
}

/// Fills in P, pixel by pixel: probability(x, y).
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

}  // namespace

Rule rule_of(Foreground foreground, bool has_color, bool has_mask, bool has_depth) {
  switch (foreground) {
    case Foreground::automatic:
      return has_mask ? Rule::mask : has_color ? Rule::color : Rule::none;
    case Foreground::color:
      return has_color ? Rule::color : Rule::none;
    case Foreground::mask:
      return has_mask ? Rule::mask : Rule::none;
    case Foreground::depth:
      return has_depth ? Rule::depth : Rule::none;
  }
  return Rule::none;
}

ViewForeground ForegroundTeller::tell(const Observation& observation, std::size_t index) {
  const TileView& view = observation.views[index];
  switch (
      rule_of(settings_.foreground, !view.color.empty(), !view.mask.empty(), !view.depth.empty())) {
    case Rule::mask:
      return fill(view, [&](int x, int y) { return view.mask.at<uchar>(y, x) ? 1.0f : 0.0f; });
    case Rule::depth: {
      const DepthRange range = range_around(observation, view.camera, settings_.range);
      return fill(view, [&](int x, int y) {
        const float z = view.depth.at<float>(y, x);
        return z > 0 && z >= range.nearest && z <= range.farthest ? 1.0f : 0.0f;
      });
    }
    case Rule::color:
      learn(observation, view);
      return fill(view, [&](int x, int y) {
        const auto& p = view.color.at<cv::Vec3b>(y, x);
        return probabilities_[static_cast<std::size_t>(bin_of(p[0], p[1], p[2]))];
      });
    case Rule::none:
      break;
  }
  return {};
}

void ForegroundTeller::learn(const Observation& observation, const TileView& view) {
  if (learned_ >= settings_.learn_frames || last_learned_ == observation.frame) return;
  const double pose_error = settings_.pose_error * scale_at(observation, view.camera);
  colors_.add(view.color,
              place_prior(silhouette(*observation.scene, observation.start, view.camera),
                          view.valid, std::max(pose_error, 0.1)));
  probabilities_ = colors_.probabilities();
  last_learned_ = observation.frame;
  ++learned_;
}

}  // namespace hypotrack::skin
