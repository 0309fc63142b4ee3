#include "track/search_space.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "hypotrack/error.hpp"
#include "track/tangent.hpp"

namespace hypotrack {
namespace {

/// Groups of the scene's parameters as groups of dimensions. Where a rotation vector stands for a
/// quaternion, it belongs where w, x and y did.
std::vector<SearchGroup> search_groups(const Scene& scene, bool rotation_vectors) {
  std::vector<SearchGroup> groups;
  int skipped = 0;  // quaternions' z components before the model
  for (const Scene::Item& item : scene.items()) {
    constexpr int kRotationZ = 6;
    auto kind = SearchGroup::Kind::pose;
    for (const std::vector<int>& parameters : parameter_groups(item.model->data())) {
      SearchGroup group{kind, {}};
      for (const int p : parameters) {
        if (rotation_vectors && p == kRotationZ) continue;
        const int own = rotation_vectors && p > kRotationZ ? 1 : 0;
        group.dimensions.push_back(item.offset + p - skipped - own);
      }
      groups.push_back(std::move(group));
      kind = SearchGroup::Kind::limb;
    }
    if (rotation_vectors) ++skipped;
  }
  return groups;
}

}  // namespace

std::span<const std::string_view> enum_names(RotationSearch) {
  static constexpr std::array<std::string_view, 2> names{"quaternion", "tangent"};
  return names;
}

SearchSpace::SearchSpace(const Scene& scene, const SearchSettings& settings)
    : scene_(&scene), settings_(settings), dimension_(scene.dimension()) {
  if (settings_.rotation_as == RotationSearch::tangent)
    dimension_ -= static_cast<int>(scene.items().size());
  groups_ = search_groups(scene, rotation_vectors());
}

SearchRegion SearchSpace::region(const Eigen::VectorXd& prior,
                                 const std::optional<Reach>& reach) const {
  SearchRegion region;
  region.groups = groups_;
  for (auto* v : {&region.start, &region.lower, &region.upper, &region.spread})
    v->resize(dimension_);
  // A component of a unit quaternion changes by up to sin(angle / 2) under a rotation by the angle.
  const double component = std::sin(settings_.rotation / 2);
  const auto& parameters = scene_->parameters();
  int out = 0;
  const auto add = [&](double start, double lower, double upper, double spread) {
    region.start[out] = std::clamp(start, lower, upper);
    region.lower[out] = lower;
    region.upper[out] = upper;
    region.spread[out++] = spread;
  };
  for (int i = 0; i < scene_->dimension(); ++i) {
    const Parameter& p = parameters[static_cast<std::size_t>(i)];
    if (p.kind == ParameterKind::quaternion && settings_.rotation_as == RotationSearch::tangent) {
      const double most = reach ? std::min(reach->rotation, std::numbers::pi) : std::numbers::pi;
      for (int k = 0; k < 3; ++k) add(0, -most, most, settings_.rotation);
      i += 3;
      continue;
    }
    const double spread = p.kind == ParameterKind::position     ? settings_.position
                          : p.kind == ParameterKind::quaternion ? component
                                                                : settings_.angle;
    double lower = p.lower, upper = p.upper;
    if (reach && p.kind != ParameterKind::quaternion) {
      const double most = p.kind == ParameterKind::position ? reach->position : reach->angle;
      const double middle = std::clamp(prior[i], p.lower, p.upper);
      lower = std::max(lower, middle - most);
      upper = std::min(upper, middle + most);
    }
    add(prior[i], lower, upper, spread);
  }
  return region;
}

Eigen::MatrixXd SearchSpace::states(const Eigen::Ref<const Eigen::MatrixXd>& points,
                                    const Eigen::VectorXd& prior) const {
  if (points.rows() != dimension_)
    throw PluginError(
        fmt::format("the optimizer gave a point of {} numbers, the search has {}; this is a bug in "
                    "the optimizer",
                    points.rows(), dimension_));
  Eigen::MatrixXd states(scene_->dimension(), points.cols());
  if (settings_.rotation_as == RotationSearch::quaternion) {
    states = points;
  } else {
    int in = 0;
    for (int i = 0; i < scene_->dimension(); ++i) {
      if (scene_->parameters()[static_cast<std::size_t>(i)].kind != ParameterKind::quaternion) {
        states.row(i) = points.row(in++);
        continue;
      }
      const Eigen::Quaterniond q0(prior[i], prior[i + 1], prior[i + 2], prior[i + 3]);
      for (Eigen::Index n = 0; n < points.cols(); ++n) {
        const Eigen::Quaterniond q = q0 * rotation_exp(points.block<3, 1>(in, n));
        states.block<4, 1>(i, n) << q.w(), q.x(), q.y(), q.z();
      }
      in += 3;
      i += 3;
    }
  }
  for (Eigen::Index n = 0; n < states.cols(); ++n) scene_->normalize(states.col(n));
  return states;
}

}  // namespace hypotrack
