#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "hypotrack/export.hpp"
#include "hypotrack/scene.hpp"
#include "shape/joint_fit.hpp"

namespace hypotrack {

/// The models of a scene whose shape is looked for, and the shape parameters that they share: the
/// hands of a scene belong to one person.
class HYPOTRACK_API ShapeTargets {
 public:
  /// The models named, or all that have shape parameters. `parameters` are those to find (empty:
  /// all); the others keep their values. Throws ConfigError on a model that is not there or has
  /// none, on models of different kinds (their parameters differ), and on unknown parameters.
  ShapeTargets(const Scene& scene, const std::vector<std::string>& models,
               const std::vector<std::string>& parameters);

  /// All shape parameters of the models, with the values of the first of them.
  const std::vector<ShapeParameter>& all() const { return all_; }
  /// Those to find.
  const std::vector<ShapeParameter>& wanted() const { return wanted_; }
  /// all() with values for wanted().
  std::vector<ShapeParameter> with(const Eigen::VectorXd& values) const;
  /// What is known of wanted() beforehand, with a weight.
  ShapePrior prior(double weight) const;
  /// Values of wanted() to start from.
  Eigen::VectorXd values() const;
  /// Indices of the models in the scene.
  const std::vector<int>& models() const { return models_; }

  /// The scene with other values of wanted(), the surfaces of those models moved inwards by
  /// `thinner` metres; models that have no part in it are the same objects.
  std::unique_ptr<Scene> reshaped(const Scene& scene, const Eigen::VectorXd& values,
                                  double thinner = 0) const;

 private:
  std::vector<int> models_;
  std::vector<ShapeParameter> all_;
  std::vector<ShapeParameter> wanted_;
  std::vector<std::size_t> place_;  // of the wanted ones among all
};

}  // namespace hypotrack
