#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "bvh_joints.hpp"

namespace hypotrack::bvh {

/// A Biovision hierarchy file that grows by a frame at a time and is whole after each. Lengths are
/// metres, angles degrees; rotations are Z, then X, then Y.
class BvhFile {
 public:
  /// Writes the hierarchy. Throws OutputError.
  BvhFile(std::filesystem::path path, std::vector<Joint> joints, double frame_rate);
  /// Throws OutputError, for example on a full disk.
  void add(const Pose& pose);

  const std::vector<Joint>& joints() const { return joints_; }

 private:
  void write(const std::string& text);

  std::filesystem::path path_;
  std::vector<Joint> joints_;
  std::vector<std::size_t> order_;       ///< of the joints in the file
  std::vector<Eigen::Vector3d> angles_;  ///< of the last frame
  std::ofstream out_;
  std::streampos count_at_;  ///< where the number of frames stands
  int frames_ = 0;
};

}  // namespace hypotrack::bvh
