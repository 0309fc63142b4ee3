#pragma once

#include <Eigen/Geometry>
#include <span>

#include "base/exported.hpp"
#include "gl/gl_objects.hpp"
#include "hypotrack/api/scene.hpp"
#include "scene/bone_poser.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// A model on the OpenGL side, for drawing hypotheses. A context must be current for every call
/// except pose(), and for the destructor.
class EglModel {
 public:
  /// The item must outlive the model.
  explicit EglModel(const Scene::Item& item);

  int matrices() const { return poser_.bones(); }
  bool poses_itself() const { return item_->model->poses_itself(); }

  /// Returns the model's parameters; empty if they are out of range, so that it is not drawn.
  std::span<const double> drawable_part(std::span<const double> state) const;

  /// Writes first_from_model of every bone, 3x4 row by row.
  void pose(std::span<const double> parameters, const Eigen::Isometry3d& first_from_world,
            BonePoser::Workspace& workspace, float* matrices) const;

  /// Uploads the vertices of a model that poses itself. Throws PluginError if their number changes.
  void upload_vertices(std::span<const double> parameters) const;

  /// Binds the buffers for draw().
  void bind() const;
  void draw(int instances) const;

 private:
  const Scene::Item* item_;
  BonePoser poser_;
  bool two_sided_;
  gl::VertexArray vertex_array_;
  gl::Buffer positions_, bones_, weights_, triangles_;
};

}  // namespace internal
}  // namespace hypotrack
