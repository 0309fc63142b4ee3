#include "stick_hand.hpp"

#include <array>
#include <string>
#include <vector>

#include "hypotrack/plugin/params.hpp"

namespace hypotrack::test {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

class StickBuilder {
 public:
  void add_bone(const std::string& name, const std::string& parent, const Isometry3d& place) {
    imported_.bones.push_back({name, parent, place});
    for (const Vector3d& corner :
         {Vector3d(0, 0, 0), Vector3d(0.002, 0, 0), Vector3d(0, 0, 0.002)}) {
      points_.push_back((place * corner).cast<float>());
      owners_.push_back(static_cast<int>(imported_.bones.size()) - 1);
    }
  }

  ImportedMesh finish() {
    Mesh& mesh = imported_.mesh;
    const auto count = static_cast<Eigen::Index>(points_.size());
    mesh.vertices.resize(3, count);
    mesh.bone_indices.setZero(4, count);
    mesh.bone_weights.setZero(4, count);
    mesh.triangles.resize(3, count / 3);
    for (Eigen::Index i = 0; i < count; ++i) {
      mesh.vertices.col(i) = points_[static_cast<std::size_t>(i)];
      mesh.bone_indices(0, i) = owners_[static_cast<std::size_t>(i)];
      mesh.bone_weights(0, i) = 1;
      mesh.triangles(i % 3, i / 3) = static_cast<int>(i);
    }
    return imported_;
  }

 private:
  ImportedMesh imported_;
  std::vector<Eigen::Vector3f> points_;
  std::vector<int> owners_;
};

Matrix3d turn(double abduction_deg, double twist_deg, double flexion_deg) {
  return (AngleAxisd(-abduction_deg * kDegree, Vector3d::UnitZ()) *
          AngleAxisd(twist_deg * kDegree, Vector3d::UnitY()) *
          AngleAxisd(flexion_deg * kDegree, Vector3d::UnitX()))
      .toRotationMatrix();
}

void add_finger(StickBuilder& builder, const std::string& finger, const Vector3d& joint,
                const std::array<Matrix3d, 3>& turns) {
  Isometry3d place = Isometry3d::Identity();
  place.translation() = joint;
  std::string parent = "wrist";
  for (std::size_t k = 0; k < 3; ++k) {
    place.linear() = place.linear() * turns[k];
    const std::string name = finger + "_" + std::to_string(k + 1);
    builder.add_bone(name, parent, place);
    place.translation() += place.linear().col(1) * 0.03;
    parent = name;
  }
  builder.add_bone(finger + "_tip", parent, place);
}

}  // namespace

ImportedMesh stick_hand() {
  StickBuilder builder;
  const Matrix3d straight = Matrix3d::Identity();
  builder.add_bone("wrist", "", Isometry3d::Identity());
  add_finger(builder, "thumb", {0.02, 0.02, 0}, {turn(45, -60, 0), straight, straight});
  add_finger(builder, "index", {0.03, 0.09, 0}, {turn(12, 0, 20), turn(0, 0, 30), turn(0, 0, 10)});
  add_finger(builder, "middle", {0.01, 0.09, 0}, {straight, straight, straight});
  add_finger(builder, "ring", {-0.01, 0.09, 0}, {straight, straight, straight});
  add_finger(builder, "little", {-0.03, 0.09, 0}, {straight, straight, straight});
  return builder.finish();
}

}  // namespace hypotrack::test
