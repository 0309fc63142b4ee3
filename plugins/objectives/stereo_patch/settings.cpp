#include "settings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hypotrack/plugin/kinematics.hpp"
#include "hypotrack/plugin/numbers.hpp"
#include "hypotrack/plugin/observation.hpp"
#include "hypotrack/plugin/stereo_pixels_map-inl.hpp"
#include "hypotrack/plugin/view_pixels.hpp"

namespace hypotrack::stereo_patch {
namespace {

struct Depths {
  double nearest, farthest;  ///< m
};

Depths depths_of(const Observation& observation, double margin) {
  constexpr double kNearest = 0.01;  // nothing nearer is drawn
  const Eigen::Isometry3f camera = observation.views[0].camera.camera_from_world.cast<float>();
  double nearest = std::numeric_limits<double>::infinity(), farthest = 0;
  for (const Scene::Item& item : observation.scene->items()) {
    const Eigen::Matrix3Xf vertices =
        posed_vertices(*item.model, observation.scene->part(item, observation.start));
    const Eigen::RowVectorXf z =
        (camera.linear().row(2) * vertices).array() + camera.translation().z();
    nearest = std::min(nearest, double{z.minCoeff()} - margin);
    farthest = std::max(farthest, double{z.maxCoeff()} + margin);
  }
  nearest = std::max(nearest, kNearest);
  return {nearest, std::max(farthest, nearest + margin)};
}

/// Returns by how many pixels a pixel's counterpart moves over a range of inverse depths.
double motion(const StereoMap& map, float x, float y, float w0, float w1) {
  const auto at = [&](float w) {
    return map.rectified ? scalar::map_pixel<true>(map, x, y, w)
                         : scalar::map_pixel<false>(map, x, y, w);
  };
  const auto a = at(w0), b = at(w1);
  return std::hypot(double{b.u} - double{a.u}, double{b.v} - double{a.v});
}

}  // namespace

Planes planes_around(const Observation& observation, const Settings& settings) {
  const Depths depths = depths_of(observation, settings.range);
  const auto first = static_cast<float>(1 / depths.farthest);
  const auto last = static_cast<float>(1 / depths.nearest);
  const StereoMap map = stereo_map(observation, 0, 1);
  const TileCamera& tile = observation.views[0].camera;
  const auto right = static_cast<float>(tile.width - 1);
  const auto low = static_cast<float>(tile.height - 1);
  double most = motion(map, right / 2, low / 2, first, last);
  for (const float x : {0.0f, right})
    for (const float y : {0.0f, low}) most = std::max(most, motion(map, x, y, first, last));

  const int room = std::clamp(kMostNumbers / (tile.width * tile.height), 2, kMostPlanes);
  // Views far apart see so different patches that finer steps tell nothing.
  constexpr double kLongest = 72;  // pixels that are compared step by step
  const double wanted = (std::isfinite(most) ? std::min(most, kLongest) : kLongest) / settings.step;
  const int count = std::clamp(static_cast<int>(std::ceil(wanted)) + 1, 2, room);
  return {first, (last - first) / static_cast<float>(count - 1), count};
}

double share_of(const Settings& settings, const Observation& observation) {
  if (settings.full_at_difference <= 0 || observation.context.color_difference <= 0) return 1;
  const double ratio = observation.context.color_difference / settings.full_at_difference;
  return std::min(quantize_log(ratio * ratio), 1.0);
}

}  // namespace hypotrack::stereo_patch
