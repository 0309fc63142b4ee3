#pragma once

#include <Eigen/Geometry>
#include <assimp/Importer.hpp>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

struct aiMesh;
struct aiNode;
struct aiScene;

namespace hypotrack::test {

/// A file with an animation, read by assimp.
class ImportedMotion {
 public:
  explicit ImportedMotion(const std::filesystem::path& file);

  const aiScene& scene() const { return *scene_; }
  /// Returns the end of the animation in its ticks.
  double duration() const;
  double ticks_per_second() const;
  /// Returns file_from_node of every node at a time, interpolated as glTF demands.
  std::map<std::string, Eigen::Isometry3d> nodes_at(double ticks) const;
  /// Returns the vertices of a mesh at a time, 3xV, by linear blend skinning where it has bones.
  Eigen::Matrix3Xd vertices_at(double ticks, const aiMesh& mesh) const;

 private:
  Assimp::Importer importer_;
  const aiScene* scene_;
};

}  // namespace hypotrack::test
