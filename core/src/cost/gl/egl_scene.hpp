#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "base/exported.hpp"
#include "cost/gl/egl_model.hpp"
#include "cost/gl/egl_program.hpp"
#include "gl/gl_objects.hpp"
#include "hypotrack/api/scene.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// The projection and size of a view for OpenGL.
struct EglView {
  Eigen::Matrix4f clip_from_first;  ///< from the frame of the first view's camera
  int width = 0;
  int height = 0;
};

/// A scene on the OpenGL side, for drawing hypotheses. The context of its construction must be
/// current for every call.
class EglScene {
 public:
  /// The scene must outlive it. Throws DeviceError if the vertex shader cannot select layers in
  /// this context.
  explicit EglScene(const Scene& scene);

  /// Returns the most hypotheses that pose() accepts.
  int most_hypotheses() const;

  /// Poses the columns of `states`.
  void pose(const Eigen::Ref<const Eigen::MatrixXd>& states,
            const Eigen::Isometry3d& first_from_world);
  /// Draws the posed states to the current framebuffer: view v of column i to layer i *
  /// views.size() + v.
  void draw(const Eigen::Ref<const Eigen::MatrixXd>& states, std::span<const EglView> views) const;

 private:
  void draw_instances(const EglModel& model, Eigen::Index first, Eigen::Index count,
                      std::span<const EglView> views) const;

  std::vector<EglModel> models_;
  std::vector<int> first_matrix_;  // of each model, among those of a hypothesis
  int matrix_stride_ = 0;          // matrices per hypothesis
  EglProgram program_;
  gl::Buffer matrix_buffer_;
  gl::Texture matrix_texture_;
  std::vector<float> matrices_;
  BonePoser::Workspace workspace_;
};

}  // namespace internal
}  // namespace hypotrack
