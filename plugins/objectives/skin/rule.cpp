#include "rule.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "hypotrack/api/error.hpp"
#include "hypotrack/gpu/device_objective.hpp"
#include "hypotrack/plugin/kinematics.hpp"
#include "hypotrack/plugin/objective.hpp"

namespace hypotrack::skin {
namespace {

const char* what_is_missing(Foreground foreground) {
  switch (foreground) {
    case Foreground::mask:
      return "a foreground mask; use a source that gives one, or `foreground: color`";
    case Foreground::depth:
      return "depth; use a source that gives it, or `foreground: color`";
    case Foreground::automatic:
      return "a foreground mask or colour; use a source that gives one, or `foreground: depth`";
    case Foreground::color:
      return "colour; use a source of colour images, or `foreground: depth`";
  }
  return "";
}

/// Checks the rules of all views; rule(i) returns that of view i.
template <class RuleOf>
void check_any(const Observation& observation, Foreground foreground, const RuleOf& rule) {
  const std::size_t count = observation.views.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (rule(i) != Rule::none) return;
  }
  throw DataError(fmt::format("objective skin: frame {} has {} view{}, none with {}",
                              observation.frame, count, count == 1 ? "" : "s",
                              what_is_missing(foreground)));
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

Rule rule_of(Foreground foreground, const cuda::DeviceTile& tile) {
  return rule_of(foreground, tile.has_color, tile.has_mask, tile.layout.depth != nullptr);
}

void check(const Observation& observation, Foreground foreground) {
  const auto rule = [&](std::size_t i) {
    const TileView& view = observation.views[i];
    return rule_of(foreground, !view.color.empty(), !view.mask.empty(), !view.depth.empty());
  };
  for (std::size_t i = 0; i < observation.views.size(); ++i) {
    const TileView& view = observation.views[i];
    if (rule(i) == Rule::none) continue;
    check_tile_image("skin", view.valid, CV_8UC1, view, i, "valid image");
    if (rule(i) == Rule::color) {
      check_tile_image("skin", view.color, CV_8UC3, view, i, "colour image");
    }
    if (rule(i) == Rule::mask) check_tile_image("skin", view.mask, CV_8UC1, view, i, "mask");
    if (rule(i) == Rule::depth) {
      check_tile_image("skin", view.depth, CV_32FC1, view, i, "depth image");
    }
  }
  check_any(observation, foreground, rule);
}

void check(const cuda::DeviceObservation& observation, Foreground foreground) {
  check_any(*observation.header, foreground,
            [&](std::size_t i) { return rule_of(foreground, observation.tiles[i]); });
}

DepthRange depth_range(const Observation& observation, const TileCamera& camera, double margin) {
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

}  // namespace hypotrack::skin
