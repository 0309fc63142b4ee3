#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "hypotrack/export.hpp"
#include "hypotrack/optimizer.hpp"
#include "hypotrack/params.hpp"
#include "hypotrack/scene.hpp"
#include "track/motion_limits.hpp"
#include "track/prediction.hpp"

namespace hypotrack {

/// How an optimizer sees a rotation.
enum class RotationSearch {
  quaternion,  ///< its four components, normalised when a point becomes a state (as in the paper)
  tangent,     ///< a rotation vector (3 numbers, radians) applied to the prior's rotation
};
HYPOTRACK_API std::span<const std::string_view> enum_names(RotationSearch);

/// `search:` of a scene: where a search starts, and how far from there the solution may plausibly
/// be.
struct SearchSettings {
  double position = 0.040;
  double rotation = 10 * kDegree;
  double angle = 10 * kDegree;
  RotationSearch rotation_as = RotationSearch::quaternion;
  double second_look = 0;
  PredictionSettings prediction;
  void visit(ParamVisitor& v) {
    v("position_mm", position,
      {.help = "spread of a model's position, each side",
       .min = 1e-3,
       .max = 1e4,
       .unit = "mm",
       .to_si = kMillimetre});
    v("rotation_deg", rotation,
      {.help = "spread of a model's rotation, each side",
       .min = 1e-3,
       .max = 180,
       .unit = "deg",
       .to_si = kDegree});
    v("angle_deg", angle,
      {.help = "spread of a joint angle, each side",
       .min = 1e-3,
       .max = 180,
       .unit = "deg",
       .to_si = kDegree});
    v("rotation_as", rotation_as,
      {.help = "what optimizers see of a rotation: quaternion components or a tangent vector"});
    v("second_look", second_look,
      {.help =
           "before anything has been found: share of a frame's budget that is kept to search it "
           "once more from what was found, with colours learned anew there; 0: none",
       .min = 0,
       .max = 0.9});
    v("prediction", prediction, {.help = "where a search starts"});
  }
};

/// Maps between states and the points that optimizers search. The one place that knows how
/// rotations are parametrised.
class HYPOTRACK_API SearchSpace {
 public:
  /// The scene must outlive the search space. `moving`: one flag per model; the others keep what
  /// the prior has. Empty: all move.
  SearchSpace(const Scene& scene, const SearchSettings& settings,
              const std::vector<bool>& moving = {});

  /// Length of a search point.
  int dimension() const { return dimension_; }
  /// Whether points have rotation vectors in place of quaternions.
  bool rotation_vectors() const { return settings_.rotation_as == RotationSearch::tangent; }

  /// The region around a prior state; its groups are the models' (parameter_groups()). Angles of
  /// the prior outside the models' bounds are moved onto them. With `reach`, nothing is farther
  /// from the prior along any axis; quaternions are not bounded.
  SearchRegion region(const Eigen::VectorXd& prior,
                      const std::optional<Reach>& reach = std::nullopt) const;

  /// States (DxN, normalised) of search points (dimension() x N) found around a prior.
  Eigen::MatrixXd states(const Eigen::Ref<const Eigen::MatrixXd>& points,
                         const Eigen::VectorXd& prior) const;

 private:
  const Scene* scene_;
  SearchSettings settings_;
  std::vector<int> moving_;  ///< parameters of the scene that move
  int dimension_ = 0;
  std::vector<SearchGroup> groups_;
};

}  // namespace hypotrack
