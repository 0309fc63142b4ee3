#include "hypotrack/gpu/skeleton.hpp"

#include <algorithm>

#include "hypotrack/plugin/kinematics.hpp"

namespace hypotrack {
namespace {

using cuda::BoneLayout;
using cuda::JointMotion;

void store(const Eigen::Isometry3d& transform, float* matrix) {
  Eigen::Map<Eigen::Matrix<float, 3, 4, Eigen::RowMajor>> out(matrix);
  out = transform.matrix().topRows<3>().cast<float>();
}

JointMotion to_layout(const BoneMotion& motion, int offset) {
  const Eigen::Vector3f axis = motion.axis.cast<float>();
  return {{axis.x(), axis.y(), axis.z()},
          static_cast<float>(motion.scale),
          static_cast<float>(motion.zero),
          offset + motion.parameter,
          motion.kind == MotionKind::translation ? 1 : 0};
}

}  // namespace

Skeleton::Skeleton(const Scene& scene) {
  for (const Scene::Item& item : scene.items()) {
    add(item.model->data(), item.offset);
  }
}

Skeleton::Skeleton(const ModelData& data) { add(data, 0); }

void Skeleton::add(const ModelData& data, int offset) {
  const auto bind = bind_transforms(data);
  const auto first = static_cast<int>(bones.size());
  for (std::size_t b = 0; b < data.bones.size(); ++b) {
    const Bone& bone = data.bones[b];
    BoneLayout out{};
    out.parent = bone.parent < 0 ? -1 : first + bone.parent;
    out.model = static_cast<int>(models.size());
    out.first_motion = static_cast<int>(motions.size());
    for (const BoneMotion& motion : data.motions) {
      if (motion.bone == static_cast<int>(b)) motions.push_back(to_layout(motion, offset));
    }
    out.motion_count = static_cast<int>(motions.size()) - out.first_motion;
    store(bone.parent_from_bone, out.parent_from_bone);
    store(bind[b].inverse(), out.bone_from_model);
    bones.push_back(out);
    level.push_back(out.parent < 0 ? 0 : level[static_cast<std::size_t>(out.parent)] + 1);
  }
  models.push_back({offset, static_cast<std::int32_t>(data.parameters.size())});
}

SkeletonLayout Skeleton::layout() const {
  return {static_cast<std::int32_t>(bones.size()),
          1 + *std::max_element(level.begin(), level.end()),
          level.data(),
          models.data(),
          bones.data(),
          motions.data()};
}

}  // namespace hypotrack
