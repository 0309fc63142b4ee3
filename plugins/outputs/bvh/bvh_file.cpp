#include "bvh_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <span>
#include <utility>

#include "euler_angles.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/params.hpp"

namespace hypotrack::bvh {
namespace {

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
