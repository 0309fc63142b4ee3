#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <set>

#include "model/import/steps.hpp"

namespace hypotrack::internal {
namespace {

/// Returns the bone's bind transform without scale, which glTF exporters put into rigs.
Eigen::Isometry3d bone_transform(const MeshFile& file, const mesh_wire::BoneNode& node) {
  using Rows = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;
  const Rows matrix = Eigen::Map<const Rows>(node.file_from_bone.data());
  const Eigen::Matrix3d axes = matrix.topLeftCorner<3, 3>();
  const double scale = std::cbrt(axes.determinant());
  if (!matrix.allFinite() || !(scale > 1e-9)) {
    file.fail(fmt::format(
        "the bind transform of bone '{}' is no rigid motion: NaN, flat or mirrored", node.name));
  }
  const Eigen::Matrix3d rotation = axes / scale;
  if ((rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() >
      5e-3) {
    file.fail(
        fmt::format("bone '{}' is scaled unevenly or sheared at the bind pose; apply the scale "
                    "in the program that made the file and export it again",
                    node.name));
  }
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.linear() = Eigen::Quaterniond(rotation).normalized().toRotationMatrix();
  transform.translation() = file.options.scale * matrix.topRightCorner<3, 1>();
  if (const double farthest = transform.translation().cwiseAbs().maxCoeff();
      farthest > kFarthestPoint) {
    file.fail(fmt::format("bone '{}' lies {:.3g} m from the origin; expected at most {:.0e} m",
                          node.name, farthest, kFarthestPoint));
  }
  return transform;
}

}  // namespace

std::vector<ImportedBone> convert_bones(const MeshFile& file) {
  std::vector<ImportedBone> bones;
  std::set<std::string> names;
  for (const mesh_wire::BoneNode& node : file.scene.bones) {
    if (!names.insert(node.name).second)
      file.fail(fmt::format("two bones are named '{}'", node.name));
    bones.push_back({node.name, node.parent, bone_transform(file, node)});
  }
  return bones;
}

}  // namespace hypotrack::internal
