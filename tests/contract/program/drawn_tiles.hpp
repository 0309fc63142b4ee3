#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "hypotrack/plugin/objective.hpp"

namespace hypotrack::contract {

/// An observation for objectives, with a name for messages.
struct NamedObservation {
  std::string name;
  Observation observation;
};

/// Makes observations of a scene about 0.5 m away: rectified pairs with and without foreground
/// masks, a pair whose cameras toe in, one view alone, and pairs of flat or invalid images. Then
/// views with depth, also without colour, with nothing measured, and with noise as depth.
std::vector<NamedObservation> make_observations(const Scene& scene);

/// Depth tiles with the memory they point into. Rows are wider than the tile.
class DrawnTiles {
 public:
  DrawnTiles(const std::vector<TileView>& views);
  DrawnTiles(const DrawnTiles&) = delete;
  DrawnTiles& operator=(const DrawnTiles&) = delete;
  DrawnTiles(DrawnTiles&&) = default;

  float& at(int view, int x, int y);
  /// Sets the tiles' bounds to what is covered.
  const std::vector<DepthTile>& finish();
  const std::vector<DepthTile>& tiles() const { return tiles_; }

 private:
  std::vector<std::vector<float>> memory_;
  std::vector<DepthTile> tiles_;
};

/// A hypothesis and its depth: the scene drawn in a state, or depths of no possible scene.
struct NamedHypothesis {
  std::string name;
  Eigen::VectorXd state;  ///< normalised
  DrawnTiles depth;
  bool of_the_scene;  ///< whether the depth is the scene's in this state
};

/// Draws the scene in several states by a plain rasteriser. Adds hypotheses with nothing covered,
/// one view covered only, everything covered, and noise over many orders of magnitude.
std::vector<NamedHypothesis> make_hypotheses(const Scene& scene, const Observation& observation);

}  // namespace hypotrack::contract
