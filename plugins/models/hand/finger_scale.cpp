#include "finger_scale.hpp"

#include <fmt/format.h>

#include <array>
#include <string_view>

#include "hypotrack/error.hpp"
#include "hypotrack/kinematics.hpp"

namespace hypotrack {
namespace {

constexpr std::array<std::string_view, 5> kFingers = {"thumb", "index", "middle", "ring", "little"};

/// How a bone's flesh is stretched along the bone.
struct Stretch {
  double factor = 1;
  bool first = true;  ///< of its finger: what lies behind its joint is the palm's and stays

  Eigen::Vector3d operator()(Eigen::Vector3d p) const {
    if (p.y() > 0 || !first) p.y() *= factor;
    return p;
  }
};

double factor_of(const std::vector<double>& factors, const std::string& parameter) {
  for (std::size_t f = 0; f < kFingers.size(); ++f) {
    if (parameter.starts_with(std::string(kFingers[f]) + '_')) {
      return factors.size() == 1 ? factors[0] : factors[f];
    }
  }
  return 1;
}

/// A finger's bones are those that its angles turn and what hangs on them.
std::vector<Stretch> stretches_of(const ModelData& hand, const std::vector<double>& factors) {
  std::vector<const Parameter*> driver(hand.bones.size(), nullptr);
  for (const BoneRotation& r : hand.rotations) {
    driver[static_cast<std::size_t>(r.bone)] =
        &hand.parameters[static_cast<std::size_t>(r.parameter)];
  }
  std::vector<Stretch> stretches(hand.bones.size());
  std::vector<bool> in_finger(hand.bones.size(), false);
  for (std::size_t i = 0; i < hand.bones.size(); ++i) {
    const int parent = hand.bones[i].parent;
    const bool continues = parent >= 0 && in_finger[static_cast<std::size_t>(parent)];
    if (continues) {
      stretches[i] = {stretches[static_cast<std::size_t>(parent)].factor, false};
    } else if (driver[i] != nullptr) {
      stretches[i] = {factor_of(factors, driver[i]->name), true};
    }
    in_finger[i] = continues || driver[i] != nullptr;
  }
  return stretches;
}

}  // namespace

void scale_fingers(ModelData& hand, const std::vector<double>& factors, const std::string& where) {
  if (factors.empty()) return;
  if (factors.size() != 1 && factors.size() != kFingers.size()) {
    throw ConfigError(
        fmt::format("{}: finger_scale has {} numbers, expected one for all fingers or five: thumb, "
                    "index, middle, ring, little",
                    where, factors.size()));
  }
  const std::vector<Stretch> stretches = stretches_of(hand, factors);
  const std::vector<Eigen::Isometry3d> before = bind_transforms(hand);
  for (Bone& bone : hand.bones) {
    if (bone.parent < 0) continue;
    bone.parent_from_bone.translation() =
        stretches[static_cast<std::size_t>(bone.parent)](bone.parent_from_bone.translation());
  }
  const std::vector<Eigen::Isometry3d> after = bind_transforms(hand);
  // The skinning of the bind pose, with bones that stretch.
  for (Eigen::Index v = 0; v < hand.mesh.vertices.cols(); ++v) {
    const Eigen::Vector3d vertex = hand.mesh.vertices.col(v).cast<double>();
    Eigen::Vector3d moved = Eigen::Vector3d::Zero();
    for (int k = 0; k < 4; ++k) {
      const auto bone = static_cast<std::size_t>(hand.mesh.bone_indices(k, v));
      moved += static_cast<double>(hand.mesh.bone_weights(k, v)) *
               (after[bone] * stretches[bone](before[bone].inverse() * vertex));
    }
    hand.mesh.vertices.col(v) = moved.cast<float>();
  }
  for (Landmark& landmark : hand.landmarks) {
    landmark.position = stretches[static_cast<std::size_t>(landmark.bone)](landmark.position);
  }
}

}  // namespace hypotrack
