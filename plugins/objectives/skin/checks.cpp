#include "checks.hpp"

#include <fmt/format.h>

#include "foreground.hpp"
#include "hypotrack/error.hpp"
#include "hypotrack/observation_checks.hpp"

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

}  // namespace

void check(const Observation& observation, Foreground foreground) {
  bool any = false;
  for (std::size_t i = 0; i < observation.views.size(); ++i) {
    const TileView& view = observation.views[i];
    const Rule rule =
        rule_of(foreground, !view.color.empty(), !view.mask.empty(), !view.depth.empty());
    if (rule == Rule::none) continue;
    any = true;
    check_tile_image("skin", view.valid, CV_8UC1, view, i, "valid image");
    if (rule == Rule::color) check_tile_image("skin", view.color, CV_8UC3, view, i, "colour image");
    if (rule == Rule::mask) check_tile_image("skin", view.mask, CV_8UC1, view, i, "mask");
    if (rule == Rule::depth) check_tile_image("skin", view.depth, CV_32FC1, view, i, "depth image");
  }
  if (any) return;
  throw DataError(fmt::format("objective skin: frame {} has {} view{}, none with {}",
                              observation.frame, observation.views.size(),
                              observation.views.size() == 1 ? "" : "s",
                              what_is_missing(foreground)));
}

}  // namespace hypotrack::skin
