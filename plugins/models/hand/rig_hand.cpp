#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "cut.hpp"
#include "hand_parameters.hpp"
#include "hypotrack/error.hpp"
#include "hypotrack/model.hpp"
#include "names.hpp"
#include "rig.hpp"

namespace hypotrack {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kSameThing = 1e-4;  // metres: points closer than this give no direction
constexpr double kSmallestBend = 2 * kDegree;

/// The three angles of a bone in its zero frame (rig.hpp, "Angles").
struct BoneAngles {
  double abduction = 0;
  double twist = 0;
  double flexion = 0;
};

Matrix3d rotation(const BoneAngles& angles) {
  return (AngleAxisd(-angles.abduction, Vector3d::UnitZ()) *
          AngleAxisd(angles.twist, Vector3d::UnitY()) *
          AngleAxisd(angles.flexion, Vector3d::UnitX()))
      .toRotationMatrix();
}

/// The inverse of rotation(): yaw, pitch and roll.
BoneAngles angles_of(const Matrix3d& r) {
  return {-std::atan2(r(1, 0), r(0, 0)), std::asin(std::clamp(-r(2, 0), -1.0, 1.0)),
          std::atan2(r(2, 1), r(2, 2))};
}

std::optional<Vector3d> axis_by_name(const std::string& name) {
  static const std::map<std::string, Vector3d> kAxes = {
      {"x", Vector3d::UnitX()},   {"-x", -Vector3d::UnitX()}, {"y", Vector3d::UnitY()},
      {"-y", -Vector3d::UnitY()}, {"z", Vector3d::UnitZ()},   {"-z", -Vector3d::UnitZ()}};
  const auto found = kAxes.find(name);
  return found == kAxes.end() ? std::nullopt : std::optional(found->second);
}

/// A left hand's file becomes a right hand's: the rig is written for one.
void mirror_in_file(ImportedMesh& imported) {
  const Vector3d flip(-1, 1, 1);
  imported.mesh.vertices.row(0) *= -1;
  imported.mesh.triangles.row(1).swap(imported.mesh.triangles.row(2));
  if (imported.mesh.uv_triangles.cols() > 0) {
    imported.mesh.uv_triangles.row(1).swap(imported.mesh.uv_triangles.row(2));
  }
  for (ImportedBone& bone : imported.bones) {
    bone.file_from_bone.linear() =
        flip.asDiagonal() * bone.file_from_bone.linear() * flip.asDiagonal();
    bone.file_from_bone.translation() = flip.asDiagonal() * bone.file_from_bone.translation();
  }
}

class Rigger {
 public:
  Rigger(ImportedMesh imported, const Rig& rig, const std::string& where)
      : in_(std::move(imported)), rig_(rig), where_(where) {}

  ModelData run() {
    if (in_.bones.empty()) fail("the mesh has no bones: a hand needs a skinned mesh");
    if (rig_.bones.empty()) fail("the rig lists no bones");
    if (rig_.side == Side::left) mirror_in_file(in_);
    name_things();
    move_to_hand_frame();
    assign_weights();
    data_.parameters = pose_parameters();
    add_angles();
    for (std::size_t i = 0; i < rig_.bones.size(); ++i) add_bone(i);
    add_landmarks();
    data_.mesh = std::move(in_.mesh);
    if (rig_.cut) cut_below(data_.mesh, -*rig_.cut, where_);
    validate(data_, where_);
    return rig_.side == Side::left ? mirrored(data_) : std::move(data_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw DataError(where_ + ": " + what); }

  // --- names

  void name_things() {
    for (std::size_t i = 0; i < in_.bones.size(); ++i) {
      file_bones_[in_.bones[i].name] = i;
      file_names_.push_back(in_.bones[i].name);
    }
    for (std::size_t i = 0; i < rig_.bones.size(); ++i) {
      if (!rig_bones_.emplace(rig_.bones[i].name, static_cast<int>(i)).second) {
        fail(fmt::format("two bones are named '{}'", rig_.bones[i].name));
      }
      rig_names_.push_back(rig_.bones[i].name);
    }
    for (const Parameter& angle : hand_angles()) angle_names_.push_back(angle.name);
  }

  std::size_t file_bone(const std::string& name, const std::string& who) const {
    const auto found = file_bones_.find(name);
    if (found == file_bones_.end()) {
      fail(fmt::format("{} names the bone '{}', which the mesh file does not have{}", who, name,
                       did_you_mean(name, file_names_)));
    }
    return found->second;
  }

  int rig_bone(const std::string& name, const std::string& who) const {
    const auto found = rig_bones_.find(name);
    if (found == rig_bones_.end()) {
      fail(fmt::format("{} names the bone '{}', which the rig does not have{}", who, name,
                       did_you_mean(name, rig_names_)));
    }
    return found->second;
  }

  int angle_index(const std::string& name, const std::string& who) const {
    const auto found = std::find(angle_names_.begin(), angle_names_.end(), name);
    if (found == angle_names_.end()) {
      fail(fmt::format("{} names the parameter '{}', which a hand does not have{}", who, name,
                       did_you_mean(name, angle_names_)));
    }
    return static_cast<int>(found - angle_names_.begin());
  }

  static std::string who(const RigBone& bone) { return fmt::format("bone '{}'", bone.name); }

  // --- the hand frame

  Vector3d file_axis(const std::string& name, const char* key) const {
    const auto axis = axis_by_name(name);
    if (!axis) {
      fail(fmt::format("`frame: {}` is '{}': it must be x, -x, y, -y, z or -z", key, name));
    }
    return rig_.side == Side::left ? Vector3d(-axis->x(), axis->y(), axis->z()) : *axis;
  }

  Vector3d joint_in_file(const std::string& name, const char* key) const {
    return in_.bones[file_bone(name, fmt::format("`frame: {}`", key))].file_from_bone.translation();
  }

  void move_to_hand_frame() {
    const RigFrame& frame = rig_.frame;
    if (frame.x.empty() == frame.radial.empty() || frame.y.empty() == frame.distal.empty()) {
      fail(
          "`frame` must give +X by either `x` (a file axis) or `radial` (two file bones), and +Y "
          "by "
          "either `y` (a file axis) or `distal` (a file bone)");
    }
    if (!frame.radial.empty() && frame.radial.size() != 2) {
      fail(fmt::format("`frame: radial` has {} entries instead of two bones", frame.radial.size()));
    }
    const std::string& first = frame.origin.empty() ? rig_.bones.front().joint : frame.origin;
    const Vector3d origin = joint_in_file(first, "origin");
    const Vector3d y = frame.distal.empty()
                           ? file_axis(frame.y, "y")
                           : Vector3d(joint_in_file(frame.distal, "distal") - origin);
    Vector3d x = frame.radial.empty() ? file_axis(frame.x, "x")
                                      : Vector3d(joint_in_file(frame.radial[1], "radial") -
                                                 joint_in_file(frame.radial[0], "radial"));
    x -= x.dot(y) / y.squaredNorm() * y;
    if (!(x.norm() > kSameThing) || !(y.norm() > kSameThing)) {
      fail("`frame` gives no axes: its +X and +Y are parallel, or its bones are in one place");
    }
    Isometry3d file_from_hand = Isometry3d::Identity();
    file_from_hand.linear() << x.normalized(), y.normalized(), x.cross(y).normalized();
    file_from_hand.translation() = origin;
    hand_from_file_ = file_from_hand.inverse();
    in_.mesh.vertices = hand_from_file_.cast<float>() * in_.mesh.vertices;
    for (ImportedBone& bone : in_.bones) {
      bone.file_from_bone = hand_from_file_ * bone.file_from_bone;  // hand_from_bone from here on
    }
  }

  // --- which bone moves which vertex

  void assign_weights() {
    std::vector<int> rig_of_file(in_.bones.size(), -1);
    for (std::size_t i = 0; i < rig_.bones.size(); ++i) {
      const RigBone& bone = rig_.bones[i];
      std::vector<std::string> names = bone.weights;
      if (names.empty() && !bone.joint.empty()) names.push_back(bone.joint);
      for (const std::string& name : names) {
        int& owner = rig_of_file[file_bone(name, who(bone) + ", `weights`,")];
        if (owner >= 0) {
          fail(fmt::format("the weights of the file's bone '{}' go to both '{}' and '{}'", name,
                           rig_names_[static_cast<std::size_t>(owner)], bone.name));
        }
        owner = static_cast<int>(i);
      }
    }
    check_all_assigned(rig_of_file);
    for (Eigen::Index v = 0; v < in_.mesh.vertices.cols(); ++v) reassign(v, rig_of_file);
  }

  void check_all_assigned(const std::vector<int>& rig_of_file) const {
    std::set<std::string> left_out;
    for (Eigen::Index v = 0; v < in_.mesh.vertices.cols(); ++v) {
      for (int k = 0; k < 4; ++k) {
        const auto bone = static_cast<std::size_t>(in_.mesh.bone_indices(k, v));
        if (in_.mesh.bone_weights(k, v) > 0 && rig_of_file[bone] < 0) {
          left_out.insert(in_.bones[bone].name);
        }
      }
    }
    if (!left_out.empty()) {
      fail(
          fmt::format("no bone of the rig takes the vertices of the file's bones '{}': add them to "
                      "the `weights` of the bones that they go with",
                      fmt::join(left_out, "', '")));
    }
  }

  /// File bones become rig bones; those that went to the same one add up.
  void reassign(Eigen::Index v, const std::vector<int>& rig_of_file) {
    Eigen::Vector4i bones = Eigen::Vector4i::Zero();
    Eigen::Vector4f weights = Eigen::Vector4f::Zero();
    int count = 0;
    for (int k = 0; k < 4; ++k) {
      const float weight = in_.mesh.bone_weights(k, v);
      if (weight <= 0) continue;
      const int bone = rig_of_file[static_cast<std::size_t>(in_.mesh.bone_indices(k, v))];
      int slot = 0;
      while (slot < count && bones[slot] != bone) ++slot;
      count = std::max(count, slot + 1);
      bones[slot] = bone;
      weights[slot] += weight;
    }
    in_.mesh.bone_indices.col(v) = bones;
    in_.mesh.bone_weights.col(v) = weights / weights.sum();
  }

  // --- bones

  void add_angles() {
    for (const Parameter& angle : hand_angles()) data_.parameters.push_back(angle);
    for (const RigParameter& given : rig_.parameters) {
      Parameter& angle = parameter(angle_index(given.name, "`parameters`"));
      if (!given.bounds.empty()) {
        if (given.bounds.size() != 2 || !(given.bounds[0] < given.bounds[1])) {
          fail(fmt::format("`bounds_deg` of '{}' must be a lower and a higher value", given.name));
        }
        angle.lower = given.bounds[0];
        angle.upper = given.bounds[1];
      }
      angle.rest = std::clamp(given.rest.value_or(0), angle.lower, angle.upper);
      if (given.rest && angle.rest != *given.rest) {
        fail(fmt::format("`rest_deg` of '{}' is {:.6g}, outside its bounds {:.6g} .. {:.6g}",
                         given.name, *given.rest / kDegree, angle.lower / kDegree,
                         angle.upper / kDegree));
      }
      if (given.bind) bind_[given.name] = *given.bind;
    }
  }

  Parameter& parameter(int angle) {
    return data_.parameters[pose_parameters().size() + static_cast<std::size_t>(angle)];
  }

  void add_bone(std::size_t index) {
    const RigBone& bone = rig_.bones[index];
    if (index == 0) {
      if (!bone.parent.empty() || !bone.abduction.empty() || !bone.flexion.empty()) {
        fail(fmt::format("the first bone, '{}', is the root: it has no parent and no parameters",
                         bone.name));
      }
      data_.bones.push_back({bone.name, -1, Isometry3d::Identity()});
      hand_from_bone_.push_back(Isometry3d::Identity());
      ends_.push_back(Vector3d::Zero());
      return;
    }
    const int parent = parent_of(index);
    const Vector3d joint = joint_of(bone);
    const Vector3d end = end_of(index, joint);
    if (!((end - joint).norm() > kSameThing)) {
      fail(fmt::format("bone '{}' begins and ends in the same place", bone.name));
    }
    ends_.push_back(end);
    place_bone(index, parent, joint, (end - joint).normalized());
  }

  int parent_of(std::size_t index) const {
    const RigBone& bone = rig_.bones[index];
    if (bone.parent.empty()) {
      fail(fmt::format("bone '{}' has no parent; only the first bone, '{}', may be the root",
                       bone.name, rig_names_[0]));
    }
    const int parent = rig_bone(bone.parent, who(bone) + ", `parent`,");
    if (parent >= static_cast<int>(index)) {
      fail(
          fmt::format("the parent of bone '{}' is '{}', which comes later or is itself: parents "
                      "come before their children, without cycles",
                      bone.name, bone.parent));
    }
    return parent;
  }

  Vector3d file_point(const std::vector<double>& point, const std::string& key) const {
    if (point.size() != 3)
      fail(fmt::format("{} has {} numbers instead of three", key, point.size()));
    Vector3d p = Eigen::Map<const Vector3d>(point.data()) * rig_.scale;
    if (rig_.side == Side::left) p.x() = -p.x();
    return hand_from_file_ * p;
  }

  Vector3d joint_of(const RigBone& bone) const {
    if (bone.joint.empty() == bone.joint_at.empty() && bone.joint.empty()) {
      fail(fmt::format("bone '{}' needs a `joint` (a bone of the file) or `joint_at`", bone.name));
    }
    if (!bone.joint_at.empty()) {
      return file_point(bone.joint_at, fmt::format("`joint_at` of bone '{}'", bone.name));
    }
    return in_.bones[file_bone(bone.joint, who(bone) + ", `joint`,")].file_from_bone.translation();
  }

  Vector3d end_of(std::size_t index, const Vector3d& joint) const {
    const RigBone& bone = rig_.bones[index];
    if (!bone.end_at.empty()) {
      return file_point(bone.end_at, fmt::format("`end_at` of bone '{}'", bone.name));
    }
    if (!bone.end.empty()) {
      return in_.bones[file_bone(bone.end, who(bone) + ", `end`,")].file_from_bone.translation();
    }
    Vector3d farthest = joint;
    for (Eigen::Index v = 0; v < in_.mesh.vertices.cols(); ++v) {
      const Vector3d p = in_.mesh.vertices.col(v).cast<double>();
      float held = 0;
      for (int k = 0; k < 4; ++k) {
        if (in_.mesh.bone_indices(k, v) == static_cast<int>(index)) {
          held += in_.mesh.bone_weights(k, v);
        }
      }
      if (held > 0.5f && (p - joint).norm() > (farthest - joint).norm()) farthest = p;
    }
    return farthest;
  }

  /// The bone that a bone's angles are measured against: its parent, or what that is rigid with.
  int moving_parent(int parent) const {
    while (parent > 0 && rig_.bones[static_cast<std::size_t>(parent)].abduction.empty() &&
           rig_.bones[static_cast<std::size_t>(parent)].flexion.empty()) {
      parent = data_.bones[static_cast<std::size_t>(parent)].parent;
    }
    return parent;
  }

  void place_bone(std::size_t index, int parent, const Vector3d& joint, const Vector3d& y) {
    const RigBone& bone = rig_.bones[index];
    const Matrix3d zero =
        hand_from_bone_[static_cast<std::size_t>(moving_parent(parent))].linear() *
        rotation({bone.zero[0], bone.zero[1], bone.zero[2]});
    Vector3d x = flexion_axis(index, parent, zero, y);
    x = AngleAxisd(bone.twist, y) * (x - x.dot(y) * y).normalized();
    Isometry3d hand_from_bone = Isometry3d::Identity();
    hand_from_bone.linear() << x, y, x.cross(y);
    hand_from_bone.translation() = joint;
    const Isometry3d& hand_from_parent = hand_from_bone_[static_cast<std::size_t>(parent)];
    data_.bones.push_back({bone.name, parent, hand_from_parent.inverse() * hand_from_bone});
    hand_from_bone_.push_back(hand_from_bone);
    const BoneAngles bind = angles_of(zero.transpose() * hand_from_bone.linear());
    const Matrix3d after_abduction = rotation({0, bind.twist, bind.flexion});
    drive(index, bone.abduction, after_abduction.transpose() * -Vector3d::UnitZ(), bind.abduction);
    drive(index, bone.flexion, Vector3d::UnitX(), bind.flexion);
  }

  Vector3d flexion_axis(std::size_t index, int parent, const Matrix3d& zero,
                        const Vector3d& y) const {
    const RigBone& bone = rig_.bones[index];
    const std::string& source = bone.flexion_axis.empty() ? rig_.flexion_axis : bone.flexion_axis;
    Vector3d axis;
    if (source == "hand") {
      const Vector3d d = zero.transpose() * y;
      const double abduction = std::atan2(d.x(), d.y());
      axis = zero * Vector3d(std::cos(abduction), -std::sin(abduction), 0);
    } else if (source == "bend") {
      axis = bend_axis(index, parent, zero, y);
    } else if (const auto local = axis_by_name(source)) {
      if (bone.joint.empty()) {
        fail(
            fmt::format("bone '{}' has no `joint` whose axis '{}' could be; say `flexion_axis: "
                        "hand` or `bend`",
                        bone.name, source));
      }
      // A rotation axis mirrors the other way round: two of its components change sign.
      const Vector3d a =
          rig_.side == Side::left ? Vector3d(local->x(), -local->y(), -local->z()) : *local;
      axis = in_.bones[file_bone(bone.joint, who(bone))].file_from_bone.linear() * a;
    } else {
      fail(
          fmt::format("`flexion_axis` of bone '{}' is '{}': it must be hand, bend, x, -x, y, -y, z "
                      "or -z",
                      bone.name, source));
    }
    if (!(axis.cross(y).norm() > std::sin(kSmallestBend))) {
      fail(fmt::format("the flexion axis of bone '{}' runs along the bone", bone.name));
    }
    return axis;
  }

  /// The normal of the plane in which the finger is bent at the bind pose.
  Vector3d bend_axis(std::size_t index, int parent, const Matrix3d& zero, const Vector3d& y) const {
    Vector3d axis;
    if (moving_parent(parent) > 0) {
      axis = hand_from_bone_[static_cast<std::size_t>(parent)].linear().col(1).cross(y);
    } else {
      const RigBone& bone = rig_.bones[index];
      const auto child = std::find_if(rig_.bones.begin(), rig_.bones.end(),
                                      [&](const RigBone& b) { return b.parent == bone.name; });
      if (child == rig_.bones.end()) fail(fmt::format("bone '{}' has no next joint", bone.name));
      const Vector3d joint = joint_of(*child);
      const auto next = static_cast<std::size_t>(child - rig_.bones.begin());
      axis = y.cross((end_of(next, joint) - joint).normalized());
    }
    if (axis.norm() < std::sin(kSmallestBend)) {
      fail(fmt::format(
          "bone '{}' is bent by only {:.2g} degrees in the file, too little to tell its "
          "flexion axis: say `flexion_axis: hand` or an axis of the file's bone",
          rig_.bones[index].name, std::asin(axis.norm()) / kDegree));
    }
    return axis.dot(zero.col(0)) < 0 ? Vector3d(-axis) : axis;
  }

  void drive(std::size_t index, const std::string& name, const Vector3d& axis, double measured) {
    if (name.empty()) return;
    const RigBone& bone = rig_.bones[index];
    const int angle = angle_index(name, who(bone));
    if (!driven_.emplace(name, static_cast<int>(index)).second) {
      fail(fmt::format("the parameter '{}' turns both '{}' and '{}'", name,
                       rig_names_[static_cast<std::size_t>(driven_.at(name))], bone.name));
    }
    const auto bind = bind_.find(name);
    data_.rotations.push_back(
        {static_cast<int>(index), static_cast<int>(pose_parameters().size()) + angle,
         axis.normalized(), bind == bind_.end() ? measured : bind->second, 1});
  }

  // --- landmarks

  void add_landmarks() {
    for (const std::string& name : angle_names_) {
      if (!driven_.contains(name)) {
        fail(fmt::format("no bone is turned by the parameter '{}'; a hand has all of its 20 angles",
                         name));
      }
    }
    std::map<std::string, const RigLandmark*> given;
    for (const RigLandmark& landmark : rig_.landmarks) {
      const auto& known = hand_landmarks();
      if (std::find(known.begin(), known.end(), landmark.name) == known.end()) {
        fail(fmt::format("`landmarks` names '{}', which a hand does not have{}", landmark.name,
                         did_you_mean(landmark.name, known)));
      }
      given[landmark.name] = &landmark;
    }
    for (const std::string& name : hand_landmarks()) {
      const auto replaced = given.find(name);
      data_.landmarks.push_back(
          replaced == given.end()
              ? default_landmark(name)
              : Landmark{name, rig_bone(replaced->second->bone, "landmark '" + name + "'"),
                         replaced->second->position});
    }
  }

  Landmark default_landmark(const std::string& name) const {
    if (const std::string flexion = driving_flexion(name); !flexion.empty()) {
      return {name, driven_.at(flexion), Vector3d::Zero()};
    }
    if (const std::string flexion = last_flexion(name); !flexion.empty()) {
      const int bone = driven_.at(flexion);
      const auto i = static_cast<std::size_t>(bone);
      return {name, bone, hand_from_bone_[i].inverse() * ends_[i]};
    }
    return {name, 0, Vector3d::Zero()};
  }

  ImportedMesh in_;
  const Rig& rig_;
  const std::string& where_;
  Isometry3d hand_from_file_ = Isometry3d::Identity();
  ModelData data_;
  std::map<std::string, std::size_t> file_bones_;
  std::map<std::string, int> rig_bones_;
  std::vector<std::string> file_names_;
  std::vector<std::string> rig_names_;
  std::vector<std::string> angle_names_;
  std::map<std::string, double>
      bind_;                           // parameter to the bind angle that replaces the measured one
  std::map<std::string, int> driven_;  // parameter to the bone that it turns
  std::vector<Isometry3d> hand_from_bone_;  // at the bind pose
  std::vector<Vector3d> ends_;              // hand frame, at the bind pose
};

}  // namespace

ModelData rig_hand(const ImportedMesh& imported, const Rig& rig, const std::string& where) {
  return Rigger(imported, rig, where).run();
}

}  // namespace hypotrack
