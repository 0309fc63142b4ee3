#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "glb_file.hpp"
#include "hypotrack/api/scene.hpp"

namespace hypotrack::gltf {

/// A model in a glTF file: a node at its pose with nodes for its bones below, and its mesh. A model
/// without joints is one node with a mesh; other meshes have a skin.
class ModelNode {
 public:
  /// Adds the model in its rest pose. Its mesh, if it has a skin, becomes a root of the scene.
  ModelNode(GlbFile& file, const Scene::Item& item);

  /// Returns the index of the model's node.
  std::size_t root() const { return root_; }
  /// Appends the pose of one more frame.
  void add(std::span<const double> parameters);
  /// Appends the channels of all frames to an animation. `times` is an accessor of seconds.
  void animate(GlbFile& file, Json& animation, std::size_t times) const;

 private:
  /// A node that moves, with its rotations (x y z w) and positions, one per frame.
  struct Moving {
    std::size_t node;
    std::vector<Eigen::Vector4f> rotations{};
    std::vector<Eigen::Vector3f> positions{};
    void add(const Eigen::Isometry3d& pose);
  };

  void add_bones(GlbFile& file);
  void add_mesh(GlbFile& file, bool skinned);
  std::size_t add_skin(GlbFile& file) const;

  const Scene::Item* item_;
  std::size_t root_;
  std::vector<std::size_t> bones_;  ///< nodes of the bones; empty without joints
  Moving pose_;
  /// A bone that parameters move.
  struct Jointed {
    int bone;
    bool slides;
    Moving moving;
  };
  std::vector<Jointed> jointed_;
};

}  // namespace hypotrack::gltf
