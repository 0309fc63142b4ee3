#include <fmt/format.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "hypotrack/api/overlay.hpp"
#include "swarm_panels.hpp"

namespace hypotrack::particles {
namespace {

/// Colours of numbers from dark blue (lowest) to yellow (highest); grey where there is none.
cv::Mat colored(const cv::Mat1f& values, const cv::Mat1b& known, double lowest, double highest) {
  constexpr int kUnknown = 70;
  cv::Mat levels, picture;
  const double scale = 255 / std::max(highest - lowest, 1e-12);
  cv::Mat1f shown = values.clone();
  shown.setTo(lowest, ~known);
  shown.convertTo(levels, CV_8U, scale, -lowest * scale);
  cv::applyColorMap(levels, picture, cv::COLORMAP_VIRIDIS);
  picture.setTo(cv::Scalar::all(kUnknown), ~known);
  return picture;
}

Panel depth_panel(const cv::Mat1f& depth) {
  const cv::Mat1b known = depth > 0;
  double nearest = 0, farthest = 0;
  if (cv::countNonZero(known) > 0)
    cv::minMaxLoc(depth, &nearest, &farthest, nullptr, nullptr, known);
  return {fmt::format("depth: near {:.0f} mm, far {:.0f} mm", 1000 * nearest, 1000 * farthest),
          colored(-depth, known, -farthest, -nearest)};
}

Panel map_panel(const TermMap& from) {
  const cv::Mat1f values = from.map.values;
  const cv::Mat1b known = values == values;  // not NaN
  return {fmt::format("{}: {:.3g} to {:.3g}", from.map.name, from.map.lowest, from.map.highest),
          colored(values, known, from.map.lowest, from.map.highest)};
}

}  // namespace

Camera panel_camera(const TileCamera& tile) {
  const double x = static_cast<double>(kPanel) / tile.width;
  const double y = static_cast<double>(kPanel) / tile.height;
  Camera camera;
  camera.width = camera.height = kPanel;
  camera.fx = x * tile.fx;
  camera.fy = y * tile.fy;
  camera.cx = x * (tile.cx + 0.5) - 0.5;
  camera.cy = y * (tile.cy + 0.5) - 0.5;
  camera.camera_from_world = tile.camera_from_world;
  return camera;
}

cv::Mat panel_picture(const TileView& view) {
  const cv::Mat picture = picture_of({.color = view.color, .depth = view.depth});
  cv::Mat out(kPanel, kPanel, CV_8UC3, cv::Scalar::all(0));
  if (!picture.empty()) cv::resize(picture, out, out.size(), 0, 0, cv::INTER_LINEAR);
  return out;
}

std::vector<std::vector<cv::Point>> outlines(Renderer& renderer, const Eigen::VectorXd& state,
                                             const Camera& camera) {
  const RenderedView drawn = renderer.render(state, camera, {.textured = false});
  std::vector<std::vector<cv::Point>> lines;
  cv::findContours(drawn.label > 0, lines, cv::RETR_CCOMP, cv::CHAIN_APPROX_NONE);
  return lines;
}

std::vector<Panel> map_panels(Renderer& renderer, const SearchRecord& record, std::size_t view) {
  const TileView& tile = record.observation.views[view];
  cv::Mat picture = panel_picture(tile);
  cv::polylines(picture, outlines(renderer, record.state, panel_camera(tile.camera)), true,
                cv::Scalar(80, 230, 255), 1, cv::LINE_AA);
  std::vector<Panel> panels{{"picture, outline of the answer", picture},
                            depth_panel(record.depth[view])};
  for (const TermMap& map : record.maps)
    if (static_cast<std::size_t>(map.map.view) == view) panels.push_back(map_panel(map));
  return panels;
}

}  // namespace hypotrack::particles
