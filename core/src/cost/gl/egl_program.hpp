#pragma once

#include <Eigen/Core>

#include "base/exported.hpp"
#include "gl/gl_objects.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// The shader program that draws hypotheses, with its uniforms. The context of its construction
/// must be current for every call.
class EglProgram {
 public:
  EglProgram() = default;
  /// Compiles the program for `matrix_stride` matrices per hypothesis. Throws DeviceError if that
  /// fails.
  explicit EglProgram(int matrix_stride);

  void set_view_count(int count) const;
  /// Sets the index of the model's first matrix among those of a hypothesis.
  void set_model(int first_matrix) const;
  /// Sets the hypothesis that instance 0 draws.
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

}  // namespace internal
}  // namespace hypotrack
