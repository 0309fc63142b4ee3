#include "track/search/search_space.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "hypotrack/api/error.hpp"
#include "track/tangent.hpp"

namespace hypotrack::internal {
namespace {

/// Returns the moving models' parameter groups as groups of dimensions. A rotation vector takes the
/// place of the quaternion's w, x and y.
std::vector<SearchGroup> search_groups(const Scene& scene, const std::vector<bool>& moving,
                                       bool rotation_vectors) {
  std::vector<SearchGroup> groups;
  int first = 0;  // dimension of the model
  for (std::size_t m = 0; m < moving.size(); ++m) {
    if (!moving[m]) continue;
    const Model& model = *scene.items()[m].model;
    constexpr int kRotationZ = 6;
    auto kind = SearchGroup::Kind::pose;
    for (const std::vector<int>& parameters : parameter_groups(model.data())) {
      SearchGroup group{kind, {}};
      for (const int p : parameters) {
        if (rotation_vectors && p == kRotationZ) continue;
        group.dimensions.push_back(first + p - (rotation_vectors && p > kRotationZ ? 1 : 0));
      }
      groups.push_back(std::move(group));
      kind = SearchGroup::Kind::limb;
    }
    first += model.dimension() - (rotation_vectors ? 1 : 0);
  }
  return groups;
}

}  // namespace

std::span<const std::string_view> enum_names(RotationCoordinates) {
  static constexpr std::array<std::string_view, 2> names{"quaternion", "tangent"};
  return names;
}

SearchSpace::SearchSpace(const Scene& scene, const SearchSettings& settings,
                         const std::vector<bool>& moving)
    : scene_(&scene), settings_(settings) {
  const std::vector<bool> moves =
      moving.empty() ? std::vector<bool>(scene.items().size(), true) : moving;
  for (std::size_t m = 0; m < moves.size(); ++m) {
    if (!moves[m]) continue;
    const Scene::Item& item = scene.items()[m];
    for (int i = 0; i < item.model->dimension(); ++i) moving_.push_back(item.offset + i);
    dimension_ += item.model->dimension() - (rotation_vectors() ? 1 : 0);
  }
  groups_ = search_groups(scene, moves, rotation_vectors());
}

SearchRegion SearchSpace::region(const Eigen::VectorXd& prior,
                                 const std::optional<Reach>& reach) const {
  SearchRegion region;
  region.groups = groups_;
  for (auto* v : {&region.start, &region.lower, &region.upper, &region.spread})
    v->resize(dimension_);
  // A rotation by an angle changes a unit quaternion's components by up to sin(angle / 2).
  const double component = std::sin(settings_.rotation / 2);
  const auto& parameters = scene_->parameters();
  int out = 0;
  const auto add = [&](double start, double lower, double upper, double spread) {
    region.start[out] = std::clamp(start, lower, upper);
    region.lower[out] = lower;
    region.upper[out] = upper;
    region.spread[out++] = spread;
  };
  for (std::size_t k = 0; k < moving_.size(); ++k) {
    const int i = moving_[k];
    const Parameter& p = parameters[static_cast<std::size_t>(i)];
    if (p.kind == ParameterKind::quaternion && rotation_vectors()) {
      const double most = reach ? std::min(reach->rotation, std::numbers::pi) : std::numbers::pi;
      for (int axis = 0; axis < 3; ++axis) add(0, -most, most, settings_.rotation);
      k += 3;
      continue;
    }
    const double spread = is_in_metres(p.kind)                  ? settings_.position
                          : p.kind == ParameterKind::quaternion ? component
                                                                : settings_.angle;
    double lower = p.lower, upper = p.upper;
    if (reach && p.kind != ParameterKind::quaternion) {
      const double most = is_in_metres(p.kind) ? reach->position : reach->angle;
      const double middle = std::clamp(prior[i], p.lower, p.upper);
      lower = std::max(lower, middle - most);
      upper = std::min(upper, middle + most);
    }
    add(prior[i], lower, upper, spread);
  }
  return region;
}

Eigen::VectorXd SearchSpace::point(const Eigen::VectorXd& state,
                                   const Eigen::VectorXd& prior) const {
  Eigen::VectorXd point(dimension_);
  int out = 0;
  const auto quaternion = [](const Eigen::VectorXd& of, int i) {
    return Eigen::Quaterniond(of[i], of[i + 1], of[i + 2], of[i + 3]);
  };
  for (std::size_t k = 0; k < moving_.size(); ++k) {
    const int i = moving_[k];
    if (scene_->parameters()[static_cast<std::size_t>(i)].kind != ParameterKind::quaternion) {
      point[out++] = state[i];
      continue;
    }
    if (rotation_vectors()) {
      point.segment<3>(out) = rotation_log(quaternion(prior, i).conjugate() * quaternion(state, i));
      out += 3;
    } else {
      const double sign = prior.segment<4>(i).dot(state.segment<4>(i)) < 0 ? -1 : 1;
      point.segment<4>(out) = sign * state.segment<4>(i);
      out += 4;
    }
    k += 3;
  }
  return point;
}

Eigen::MatrixXd SearchSpace::states(const Eigen::Ref<const Eigen::MatrixXd>& points,
                                    const Eigen::VectorXd& prior) const {
  if (points.rows() != dimension_)
    throw PluginError(
        fmt::format("the optimizer gave a point of {} numbers, the search has {}; this is a bug in "
                    "the optimizer",
                    points.rows(), dimension_));
  Eigen::MatrixXd states = prior.replicate(1, points.cols());
  int in = 0;
  for (std::size_t k = 0; k < moving_.size(); ++k) {
    const int i = moving_[k];
    if (!rotation_vectors() ||
        scene_->parameters()[static_cast<std::size_t>(i)].kind != ParameterKind::quaternion) {
      states.row(i) = points.row(in++);
      continue;
    }
    const Eigen::Quaterniond q0(prior[i], prior[i + 1], prior[i + 2], prior[i + 3]);
    for (Eigen::Index n = 0; n < points.cols(); ++n) {
      const Eigen::Quaterniond q = q0 * rotation_exp(points.block<3, 1>(in, n));
      states.block<4, 1>(i, n) << q.w(), q.x(), q.y(), q.z();
    }
    in += 3;
    k += 3;
  }
  for (Eigen::Index n = 0; n < states.cols(); ++n) scene_->normalize(states.col(n));
  return states;
}

}  // namespace hypotrack::internal
