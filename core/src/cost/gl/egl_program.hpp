#pragma once

#include <Eigen/Core>

#include "gl/gl_objects.hpp"

namespace hypotrack {

/// The shaders that draw hypotheses, and what all vertices of a draw call share. The context that
/// it was made in must be current throughout.
class EglProgram {
 public:
  EglProgram() = default;
  /// `matrix_stride`: matrices per hypothesis. Throws DeviceError if it does not compile.
  explicit EglProgram(int matrix_stride);

  void set_view_count(int count) const;
  /// `first_matrix`: of the model, among those of a hypothesis.
  void set_model(int first_matrix) const;
  /// The hypothesis that the first instance is.
  void set_first_hypothesis(int hypothesis) const;
  void set_view(int view, const Eigen::Matrix4f& clip_from_first) const;

 private:
  gl::Program program_;
  int first_matrix_ = 0;
  int first_hypothesis_ = 0;
  int view_ = 0;
  int view_count_ = 0;
  int clip_from_first_ = 0;
};

}  // namespace hypotrack
