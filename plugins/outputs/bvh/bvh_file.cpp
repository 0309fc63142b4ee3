#include "bvh_file.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <numbers>
#include <span>
#include <utility>

#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/params.hpp"

namespace hypotrack::bvh {
namespace {

/// Adds the whole turns to each angle that bring it nearest to the previous one.
Eigen::Vector3d unwrapped(Eigen::Vector3d angles, const Eigen::Vector3d& previous) {
  constexpr double kTurn = 2 * std::numbers::pi;
  for (int i = 0; i < 3; ++i) angles[i] += kTurn * std::round((previous[i] - angles[i]) / kTurn);
  return angles;
}

/// Returns the angles z, x, y (radians) with rotation = Rz(z) Rx(x) Ry(y). Of all that give the
/// rotation, takes those nearest to `previous`, so that a curve of them has no jumps.
Eigen::Vector3d zxy_angles(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& previous) {
  constexpr double kLocked = 1e-9;  // cosine of x; below it only the sum of z and y is known
  const double x = std::asin(std::clamp(rotation(2, 1), -1.0, 1.0));
  if (std::hypot(rotation(0, 1), rotation(1, 1)) < kLocked) {
    const double sign = x > 0 ? 1 : -1;
    const double sum = std::atan2(rotation(1, 0), rotation(0, 0));  // z + sign * y
    return unwrapped({sum - sign * previous.z(), x, previous.z()}, previous);
  }
  const Eigen::Vector3d one(std::atan2(-rotation(0, 1), rotation(1, 1)), x,
                            std::atan2(-rotation(2, 0), rotation(2, 2)));
  const double half_turn = std::numbers::pi;
  const Eigen::Vector3d a = unwrapped(one, previous);
  const Eigen::Vector3d b =
      unwrapped({one[0] + half_turn, half_turn - one[1], one[2] + half_turn}, previous);
  return (a - previous).squaredNorm() <= (b - previous).squaredNorm() ? a : b;
}

/// Appends a joint and those below it, in the order in which the frames have them.
void write_joint(std::string& text, std::span<const Joint> joints, std::size_t index, int depth) {
  const Joint& joint = joints[index];
  const std::string indent(static_cast<std::size_t>(2 * depth), ' ');
  const auto offset = [&](const std::string& before, const Eigen::Vector3d& at) {
    text += fmt::format("{}OFFSET {:.7f} {:.7f} {:.7f}\n", before, at.x(), at.y(), at.z());
  };
  const bool root = joint.parent < 0;
  text += fmt::format("{0}{1} {2}\n{0}{{\n", indent, root ? "ROOT" : "JOINT", joint.name);
  offset(indent + "  ", joint.offset);
  text += fmt::format("{}  CHANNELS {}Zrotation Xrotation Yrotation\n", indent,
                      root || joint.slides ? "6 Xposition Yposition Zposition " : "3 ");
  bool leaf = true;
  for (std::size_t i = index + 1; i < joints.size(); ++i) {
    if (joints[i].parent != static_cast<int>(index)) continue;
    leaf = false;
    write_joint(text, joints, i, depth + 1);
  }
  if (leaf) {
    text += fmt::format("{0}  End Site\n{0}  {{\n", indent);
    offset(indent + "    ", joint.end);
    text += indent + "  }\n";
  }
  text += indent + "}\n";
}

/// Appends the joint and those below it: parents first, one branch after the other.
void append_branch(std::span<const Joint> joints, std::size_t index,
                   std::vector<std::size_t>& order) {
  order.push_back(index);
  for (std::size_t i = index + 1; i < joints.size(); ++i)
    if (joints[i].parent == static_cast<int>(index)) append_branch(joints, i, order);
}

std::string frame_count(int frames) { return fmt::format("{:>10}", frames); }

}  // namespace

BvhFile::BvhFile(std::filesystem::path path, std::vector<Joint> joints, double frame_rate)
    : path_(std::move(path)),
      joints_(std::move(joints)),
      angles_(joints_.size(), Eigen::Vector3d::Zero()),
      out_(path_) {
  append_branch(joints_, 0, order_);
  std::string text = "HIERARCHY\n";
  write_joint(text, joints_, 0, 0);
  write(text + "MOTION\nFrames: ");
  count_at_ = out_.tellp();
  write(frame_count(0) + fmt::format("\nFrame Time: {:.9g}\n", 1 / frame_rate));
}

void BvhFile::add(const Pose& pose) {
  std::string line;
  const auto append = [&](const Eigen::Vector3d& v, int digits) {
    for (const double x : v) line += fmt::format("{}{:.{}f}", line.empty() ? "" : " ", x, digits);
  };
  for (const std::size_t i : order_) {
    if (joints_[i].parent < 0 || joints_[i].slides) append(pose.positions[i], 7);
    angles_[i] = zxy_angles(pose.rotations[i], angles_[i]);
    append(angles_[i] / kDegree, 6);
  }
  write(line + "\n");
  out_.seekp(count_at_);
  write(frame_count(++frames_));
  out_.seekp(0, std::ios::end);
}

void BvhFile::write(const std::string& text) {
  errno = 0;
  out_ << text << std::flush;
  if (!out_)
    throw OutputError(
        fmt::format("{}: cannot be written: {}; make room or name another folder with --out",
                    path_.string(), errno != 0 ? std::strerror(errno) : "unknown reason"));
}

}  // namespace hypotrack::bvh
