#pragma once

#include <Eigen/Geometry>
#include <span>

#include "gl/gl_objects.hpp"
#include "hypotrack/scene.hpp"
#include "scene/bone_poser.hpp"

namespace hypotrack {

/// One model of a scene as OpenGL draws it. A context must be current for everything but posing,
/// and for the end of its life.
class EglModel {
 public:
  /// The item must outlive the model.
  explicit EglModel(const Scene::Item& item);

  int matrices() const { return poser_.bones(); }
  bool poses_itself() const { return item_->model->poses_itself(); }

  /// Its parameters; empty if they are out of reach, so that it is not to be drawn.
  std::span<const double> drawable_part(std::span<const double> state) const;

  /// Writes first_from_model of every bone, 3x4 row by row.
  void pose(std::span<const double> parameters, const Eigen::Isometry3d& first_from_world,
            BonePoser::Workspace& workspace, float* matrices) const;

  /// Replaces the vertices with those of a model that poses itself. Throws PluginError if their
  /// number changes.
  void upload_vertices(std::span<const double> parameters) const;

  /// Chooses what draw() draws.
  void bind() const;
  void draw(int instances) const;

 private:
  const Scene::Item* item_;
  BonePoser poser_;
  bool two_sided_;
  gl::VertexArray vertex_array_;
  gl::Buffer positions_, bones_, weights_, triangles_;
};

}  // namespace hypotrack
