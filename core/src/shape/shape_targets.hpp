#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/scene.hpp"
#include "shape/joint_fit.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// The models whose shape is estimated, and the shape parameters that they share: all are
/// models of one individual.
class ShapeTargets {
 public:
  /// Selects the named models, or all that have shape parameters. `parameters` are those to find
  /// (empty: all); the others keep their values. Throws ConfigError if a model is missing or has no
  /// shape parameters, if models are of different kinds (their parameters differ), or on unknown
  /// parameters.
  ShapeTargets(const Scene& scene, const std::vector<std::string>& models,
               const std::vector<std::string>& parameters);

  /// Returns all shape parameters of the models, with the values of the first model.
  const std::vector<ShapeParameter>& all() const { return all_; }
  /// Returns the parameters to find.
  const std::vector<ShapeParameter>& wanted() const { return wanted_; }
  /// Returns all() with given values for wanted().
  std::vector<ShapeParameter> with(const Eigen::VectorXd& values) const;
  /// Returns the prior of wanted() with a weight: means, deviations, bounds and correlations.
  /// Unwanted parameters do not affect wanted ones.
  ShapePrior prior(double weight) const;
  /// Returns the initial values of wanted().
  Eigen::VectorXd values() const;
  /// Returns the indices of the models in the scene.
  const std::vector<int>& models() const { return models_; }

  /// Returns the scene with other values of wanted() and the surfaces of those models moved inwards
  /// by `thinner` metres. Shares the other models with `scene`.
  std::unique_ptr<Scene> reshaped(const Scene& scene, const Eigen::VectorXd& values,
                                  double thinner = 0) const;

 private:
  std::vector<int> models_;
  std::vector<ShapeParameter> all_;
  std::vector<ShapeParameter> wanted_;
  std::vector<std::size_t> place_;  // index of each wanted parameter among all
};

}  // namespace internal
}  // namespace hypotrack
