#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/kinematics.hpp"

namespace hypotrack {
namespace {

/// A joint's motion in the world: a turn about a line, or a slide.
struct WorldMotion {
  Eigen::Vector3d axis;
  Eigen::Vector3d origin;  ///< a point of the line
};

/// Returns where the motions of a model's data are in the world.
std::vector<WorldMotion> motions_in_world(const ModelData& data,
                                          std::span<const Eigen::Isometry3d> world_from_bone,
                                          std::span<const double> parameters) {
  std::vector<Eigen::Isometry3d> frames;  // of every bone, before its next motion
  for (const Bone& bone : data.bones) {
    const Eigen::Isometry3d above = bone.parent < 0
                                        ? world_from_model(parameters)
                                        : world_from_bone[static_cast<std::size_t>(bone.parent)];
    frames.push_back(above * bone.parent_from_bone);
  }
  std::vector<WorldMotion> out;
  for (const BoneMotion& motion : data.motions) {
    Eigen::Isometry3d& frame = frames[static_cast<std::size_t>(motion.bone)];
    out.push_back({frame.linear() * motion.axis, frame.translation()});
    const double value = parameters[static_cast<std::size_t>(motion.parameter)];
    const double amount = motion.scale * (value - motion.zero);
    if (motion.kind == MotionKind::translation) {
      frame.translate(amount * motion.axis);
    } else {
      frame.rotate(Eigen::AngleAxisd(amount, motion.axis));
    }
  }
  return out;
}

bool carries(const ModelData& data, int mover, int bone) {
  while (bone > mover) bone = data.bones[static_cast<std::size_t>(bone)].parent;
  return bone == mover;
}

/// Returns the derivatives of a point of the model by its quaternion, for the rotation (w^2 - v.v)
/// p + 2 w v x p + 2 v (v.p), which is not normalised. `point`: in the model's frame.
Eigen::Matrix<double, 3, 4> by_quaternion(const Eigen::Vector4d& wxyz,
                                          const Eigen::Vector3d& point) {
  const double w = wxyz[0];
  const Eigen::Vector3d v = wxyz.tail<3>();
  Eigen::Matrix<double, 3, 4> out;
  out.col(0) = 2 * (w * point + v.cross(point));
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d unit = Eigen::Vector3d::Unit(i);
    out.col(1 + i) =
        2 * (w * unit.cross(point) + unit * v.dot(point) + v * point[i] - v[i] * point);
  }
  return out;
}

}  // namespace

Eigen::MatrixXd landmark_derivatives(const Model& model, std::span<const double> parameters) {
  if (model.poses_itself())
    throw Error(
        "derivatives of landmarks: expected a model that core poses, found one that poses "
        "itself");
  const ModelData& data = model.data();
  const std::vector<Eigen::Isometry3d> bones = world_from_bones(data, parameters);
  const Eigen::Isometry3d root = world_from_model(parameters);
  const std::vector<WorldMotion> motions = motions_in_world(data, bones, parameters);
  const Eigen::Vector4d wxyz(parameters[3], parameters[4], parameters[5], parameters[6]);
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(3 * std::ssize(data.landmarks), model.dimension());
  for (std::size_t i = 0; i < data.landmarks.size(); ++i) {
    const Landmark& landmark = data.landmarks[i];
    const Eigen::Vector3d point =
        bones[static_cast<std::size_t>(landmark.bone)] * landmark.position;
    auto rows = out.middleRows<3>(3 * static_cast<Eigen::Index>(i));
    rows.leftCols<3>().setIdentity();
    rows.middleCols<4>(3) = by_quaternion(wxyz, root.inverse() * point);
    for (std::size_t m = 0; m < motions.size(); ++m) {
      const BoneMotion& motion = data.motions[m];
      if (!carries(data, motion.bone, landmark.bone)) continue;
      const Eigen::Vector3d along = motion.kind == MotionKind::translation
                                        ? motions[m].axis
                                        : motions[m].axis.cross(point - motions[m].origin).eval();
      rows.col(motion.parameter) += motion.scale * along;
    }
  }
  return out;
}

}  // namespace hypotrack
