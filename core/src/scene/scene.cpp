#include "hypotrack/api/scene.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/kinematics.hpp"

namespace hypotrack {

Scene::Scene(std::vector<std::pair<std::string, std::shared_ptr<const Model>>> models) {
  if (models.empty()) throw ConfigError("scene: there is no model to track; name at least one");
  std::set<std::string> seen;
  for (auto& [name, model] : models) {
    if (!model) throw ConfigError(fmt::format("scene: there is no model behind '{}'", name));
    if (!seen.insert(name).second) {
      throw ConfigError(fmt::format(
          "scene: two models are called '{}': give each model a `name` of its own", name));
    }
    items_.push_back({name, model, dimension()});
    for (Parameter parameter : model->data().parameters) {
      parameter.name = name + "." + parameter.name;
      parameters_.push_back(std::move(parameter));
    }
    for (const Landmark& landmark : model->data().landmarks) {
      landmark_names_.push_back(name + "." + landmark.name);
    }
  }
}

Eigen::VectorXd Scene::rest_state() const {
  Eigen::VectorXd state(dimension());
  for (int i = 0; i < dimension(); ++i) state[i] = parameters_[static_cast<std::size_t>(i)].rest;
  return state;
}

std::span<const double> Scene::part(const Item& item, const Eigen::VectorXd& state) const {
  return std::span(state.data(), static_cast<std::size_t>(state.size()))
      .subspan(static_cast<std::size_t>(item.offset),
               static_cast<std::size_t>(item.model->dimension()));
}

Eigen::Matrix3Xd Scene::landmarks(const Eigen::VectorXd& state) const {
  Eigen::Matrix3Xd all(3, static_cast<Eigen::Index>(landmark_names_.size()));
  Eigen::Index column = 0;
  for (const Item& item : items_) {
    const Eigen::Matrix3Xd placed = posed_landmarks(*item.model, part(item, state));
    all.middleCols(column, placed.cols()) = placed;
    column += placed.cols();
  }
  return all;
}

void Scene::normalize(Eigen::Ref<Eigen::VectorXd> state) const {
  constexpr double kRoundOff = 8 * std::numeric_limits<double>::epsilon();
  for (const Item& item : items_) {
    auto quaternion = state.segment<4>(item.offset + 3);
    // Normalising again would change the last digit of a state that was written and read back.
    if (std::abs(quaternion.squaredNorm() - 1) <= kRoundOff) continue;
    if (quaternion.isZero(0)) quaternion[0] = 1;
    quaternion.stableNormalize();
  }
}

void Scene::check(const Eigen::VectorXd& state, const std::string& where) const {
  if (state.size() != dimension()) {
    throw ConfigError(
        fmt::format("{}: the state has {} numbers, expected {}", where, state.size(), dimension()));
  }
  constexpr double kSlack = 1e-6;
  for (int i = 0; i < dimension(); ++i) {
    const Parameter& parameter = parameters_[static_cast<std::size_t>(i)];
    if (!std::isfinite(state[i])) {
      throw ConfigError(
          fmt::format("{}: {} is {}, expected a finite number", where, parameter.name, state[i]));
    }
    const bool bounded = is_joint(parameter.kind);
    if (bounded && (state[i] < parameter.lower - kSlack || state[i] > parameter.upper + kSlack)) {
      throw ConfigError(fmt::format("{}: {} is {} {}, expected {} to {}", where, parameter.name,
                                    state[i], is_in_metres(parameter.kind) ? "m" : "rad",
                                    parameter.lower, parameter.upper));
    }
  }
}

}  // namespace hypotrack
