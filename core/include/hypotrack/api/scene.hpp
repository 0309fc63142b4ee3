#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "hypotrack/api/export.hpp"
#include "hypotrack/plugin/model.hpp"

namespace hypotrack {

/// The tracked models and their joint state. The state is the models' parameters one after the
/// other: 7 for a rigid object, 35 for it and a model of 21 joint angles.
class HYPOTRACK_API Scene {
 public:
  struct Item {
    std::string name;  ///< unique within the scene
    std::shared_ptr<const Model> model;
    int offset = 0;  ///< index of the model's first parameter in the state
  };

  /// Throws ConfigError on duplicate names or no model at all.
  explicit Scene(std::vector<std::pair<std::string, std::shared_ptr<const Model>>> models);

  const std::vector<Item>& items() const { return items_; }
  /// Returns the length of the state vector.
  int dimension() const { return static_cast<int>(parameters_.size()); }
  /// Returns the parameters of all models in the order of the state, named `model.parameter`.
  const std::vector<Parameter>& parameters() const { return parameters_; }
  /// Returns the landmark names of all models: `model.landmark`.
  const std::vector<std::string>& landmark_names() const { return landmark_names_; }

  Eigen::VectorXd rest_state() const;
  /// Returns the part of a state that belongs to one model.
  std::span<const double> part(const Item& item, const Eigen::VectorXd& state) const;
  /// Returns the world positions of all landmarks, 3xL, metres.
  Eigen::Matrix3Xd landmarks(const Eigen::VectorXd& state) const;
  /// Normalises every quaternion of a state; a zero one becomes the identity. Only this function
  /// normalises states.
  void normalize(Eigen::Ref<Eigen::VectorXd> state) const;
  /// Throws ConfigError, naming `where`, unless the state has the right length, is finite and has
  /// its joints within bounds (tolerance 1e-6).
  void check(const Eigen::VectorXd& state, const std::string& where) const;

 private:
  std::vector<Item> items_;
  std::vector<Parameter> parameters_;
  std::vector<std::string> landmark_names_;
};

}  // namespace hypotrack
