#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "base/exported.hpp"
#include "track/search/search_space.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// A dimension along which a cost is sliced.
struct LandscapeAxis {
  std::string name;  ///< of the parameter: `hand.position_x`
  std::string unit;  ///< mm or deg
  double to_unit = 1;
  Eigen::VectorXd offsets;  ///< from the centre, metres or radians, ascending
};

/// Costs along one axis, or over two of them, the first one fastest.
struct LandscapeSlice {
  std::size_t x = 0, y = 0;  ///< indices of axes; equal: along one
  Eigen::MatrixXd costs;     ///< a row per point, a column per curve
};

/// Slices of a scene's cost around a state.
struct Landscape {
  std::vector<std::string> curves;               ///< `sum`, then the terms
  Eigen::VectorXd centre;                        ///< costs at the state
  std::vector<LandscapeAxis> axes, coarse_axes;  ///< for lines, and for pairs
  std::vector<LandscapeSlice> lines, pairs;
};

struct LandscapeSettings {
  double position = 0.030;         ///< metres to each side
  double rotation = 30 * kDegree;  ///< of models and joints
  int points = 41;                 ///< along a line
  int grid = 15;                   ///< along each side of a pair
  bool all_pairs = false;          ///< also of different limbs and models
  std::vector<bool> models = {};   ///< that move; empty: all
};

/// Computes the weighted costs (N x terms) of states (DxN).
using TermCosts = std::function<Eigen::MatrixXd(const Eigen::MatrixXd& states)>;

/// Slices the costs of `terms` around a state along every parameter, and over pairs of parameters
/// of one pose or limb. A model's rotation is sliced about its own axes. Slices end at the models'
/// bounds.
Landscape measure_landscape(const Scene& scene, const Eigen::VectorXd& state,
                            const std::vector<std::string>& terms, const TermCosts& costs,
                            const LandscapeSettings& settings);

}  // namespace internal
}  // namespace hypotrack
