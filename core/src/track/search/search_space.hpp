#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/optimizer.hpp"
#include "hypotrack/plugin/params.hpp"
#include "track/motion_limits.hpp"
#include "track/prediction.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Parametrisation of rotations in search points.
enum class RotationCoordinates {
  quaternion,  ///< its four components, normalised when a point becomes a state (as in the paper)
  tangent,     ///< a rotation vector (3 numbers, radians) applied to the prior's rotation
};
std::span<const std::string_view> enum_names(RotationCoordinates);

/// `search:` of a scene: where a search starts, and how far from there it expects the solution.
struct SearchSettings {
  double position = 0.040;
  double rotation = 10 * kDegree;
  double angle = 10 * kDegree;
  RotationCoordinates rotation_as = RotationCoordinates::quaternion;
  double second_search = 0;
  PredictionSettings prediction;
  void visit(ParamVisitor& v) {
    v("position_mm", position,
      {.help = "spread of a model's position, and of a joint that slides, each side",
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
      {.help =
           "coordinates of a rotation for optimizers: quaternion components or a tangent vector"});
    v("second_search", second_search,
      {.help = "before the first solution: share of a frame's budget for a second search from the "
               "first one's answer, with colours learned there; 0: none",
       .min = 0,
       .max = 0.9});
    v("prediction", prediction, {.help = "start of a search"});
  }
};

/// Maps between states and search points. No other class knows how rotations are parametrised.
class SearchSpace {
 public:
  /// `moving` has one flag per model (empty: all move); the others keep the prior's values. The
  /// scene must outlive the search space.
  SearchSpace(const Scene& scene, const SearchSettings& settings,
              const std::vector<bool>& moving = {});

  /// Returns the length of a search point.
  int dimension() const { return dimension_; }
  /// Returns whether search points have rotation vectors in place of quaternions.
  bool rotation_vectors() const { return settings_.rotation_as == RotationCoordinates::tangent; }

  /// Returns the search region around a prior state. Its groups are the models'
  /// (parameter_groups()). Joints of the prior outside the models' bounds are moved onto them.
  /// `reach` limits the distance from the prior along every axis, except of quaternions.
  SearchRegion region(const Eigen::VectorXd& prior,
                      const std::optional<Reach>& reach = std::nullopt) const;

  /// Returns the search point of a normalised state, around a prior.
  Eigen::VectorXd point(const Eigen::VectorXd& state, const Eigen::VectorXd& prior) const;

  /// Returns the states (DxN, normalised) of search points (dimension() x N) around a prior.
  Eigen::MatrixXd states(const Eigen::Ref<const Eigen::MatrixXd>& points,
                         const Eigen::VectorXd& prior) const;

 private:
  const Scene* scene_;
  SearchSettings settings_;
  std::vector<int> moving_;  ///< indices of the scene's moving parameters
  int dimension_ = 0;
  std::vector<SearchGroup> groups_;
};

}  // namespace internal
}  // namespace hypotrack
