#pragma once

#include <string>
#include <vector>

#include "figure.hpp"
#include "hypotrack/plugin/output.hpp"

namespace hypotrack::particles {

/// The montage of a search, and a line about it.
struct SwarmRow {
  std::string label;
  std::vector<Panel> panels;  ///< empty if the hypotheses are not known
};

/// Draws the outlines of hypotheses over the first view, for a few generations from first to last.
/// The search is the one that led to the record's answer.
SwarmRow swarm_row(Renderer& renderer, const Scene& scene, const SearchRecord& record);

/// Returns the camera of a tile, enlarged to a panel.
Camera panel_camera(const TileCamera& tile);
/// Returns the tile's picture in the size of a panel, 8-bit BGR.
cv::Mat panel_picture(const TileView& view);
/// Returns where a scene in a state covers a panel, one polygon per visible outline.
std::vector<std::vector<cv::Point>> outlines(Renderer& renderer, const Eigen::VectorXd& state,
                                             const Camera& camera);

/// Returns the panels of one view: its picture with the answer's outline, the answer's depth, and
/// the terms' maps.
std::vector<Panel> map_panels(Renderer& renderer, const SearchRecord& record, std::size_t view);

}  // namespace hypotrack::particles
