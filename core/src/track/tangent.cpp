#include "track/tangent.hpp"

#include <algorithm>
#include <cmath>

namespace hypotrack::internal {
namespace {

constexpr Eigen::Index kTangentPose = 6;  // and in a difference

Eigen::Quaterniond rotation_of(const Eigen::VectorXd& state, Eigen::Index model) {
  return {state[model + 3], state[model + 4], state[model + 5], state[model + 6]};
}

}  // namespace

Eigen::Quaterniond rotation_exp(const Eigen::Vector3d& vector) {
  const double angle = vector.norm();
  if (angle < 1e-12) return {1, vector.x() / 2, vector.y() / 2, vector.z() / 2};
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, vector / angle));
}

Eigen::Vector3d rotation_log(const Eigen::Quaterniond& rotation) {
  const double sign = rotation.w() < 0 ? -1 : 1;
  const double sine = rotation.vec().norm();
  if (sine < 1e-12) return 2 * sign * rotation.vec();
  return 2 * std::atan2(sine, sign * rotation.w()) / sine * sign * rotation.vec();
}

Eigen::VectorXd difference(const Scene& scene, const Eigen::VectorXd& from,
                           const Eigen::VectorXd& to) {
  Eigen::VectorXd out(scene.dimension() - static_cast<Eigen::Index>(scene.items().size()));
  Eigen::Index at = 0;
  for (const Scene::Item& item : scene.items()) {
    const Eigen::Index i = item.offset, joints = item.model->dimension() - kPoseSize;
    out.segment<3>(at) = to.segment<3>(i) - from.segment<3>(i);
    out.segment<3>(at + 3) = rotation_log(rotation_of(from, i).conjugate() * rotation_of(to, i));
    out.segment(at + kTangentPose, joints) =
        to.segment(i + kPoseSize, joints) - from.segment(i + kPoseSize, joints);
    at += kTangentPose + joints;
  }
  return out;
}

Eigen::VectorXd moved(const Scene& scene, const Eigen::VectorXd& from,
                      const Eigen::VectorXd& difference) {
  Eigen::VectorXd out = from;
  Eigen::Index at = 0;
  for (const Scene::Item& item : scene.items()) {
    const Eigen::Index i = item.offset, joints = item.model->dimension() - kPoseSize;
    out.segment<3>(i) += difference.segment<3>(at);
    const Eigen::Quaterniond q = rotation_of(from, i) * rotation_exp(difference.segment<3>(at + 3));
    out.segment<4>(i + 3) << q.w(), q.x(), q.y(), q.z();
    for (Eigen::Index k = 0; k < joints; ++k) {
      const Parameter& p = scene.parameters()[static_cast<std::size_t>(i + kPoseSize + k)];
      double& value = out[i + kPoseSize + k];
      value = std::clamp(value + difference[at + kTangentPose + k], p.lower, p.upper);
    }
    at += kTangentPose + joints;
  }
  scene.normalize(out);
  return out;
}

std::vector<TangentPart> tangent_parts(const Scene& scene) {
  std::vector<TangentPart> parts;
  Eigen::Index at = 0;
  for (const Scene::Item& item : scene.items()) {
    parts.push_back({ParameterKind::position, at, 3});
    parts.push_back({ParameterKind::quaternion, at + 3, 3});
    at += kTangentPose;
    const std::vector<Parameter>& parameters = item.model->data().parameters;
    for (std::size_t i = kPoseSize; i < parameters.size(); ++i, ++at) {
      if (parts.back().kind == parameters[i].kind) {
        ++parts.back().size;
      } else {
        parts.push_back({parameters[i].kind, at, 1});
      }
    }
  }
  return parts;
}

}  // namespace hypotrack::internal
