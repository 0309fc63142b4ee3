#pragma once

#include <Eigen/Core>
#include <string_view>
#include <vector>

#include "hypotrack/observation.hpp"
#include "hypotrack/scene.hpp"
#include "motion_term.hpp"
#include "params.hpp"

namespace hypotrack::plausible_motion {

/// Makes the residuals of a scene's frames: first one per joint angle, then two per finger, one per
/// pair of fingers side by side, one per abduction and one per joint of a thumb.
class FrameResiduals {
 public:
  /// A model has fingers where it has parameters NAME_flexion_1, _2 and _3; the joints of a thumb
  /// do not move together.
  FrameResiduals(const PlausibleMotionParams& params, const Scene& scene);

  /// The term of a frame: in hindsight joint angles are free to differ from where its search
  /// started. Points into this object, until the next call.
  MotionTerm of(const Observation& observation);

 private:
  /// A residual for every finger with both joints: one flexion should be a share of the other.
  void couple(const std::vector<Parameter>& parameters, std::string_view joint,
              std::string_view before, double share, double sigma);
  /// A residual for every two fingers side by side: their knuckles should be bent alike.
  void couple_neighbors(const Scene& scene, double sigma);
  /// A residual for every parameter of a finger or thumb of that name: it should be at `rest`.
  void hold(const std::vector<Parameter>& parameters, bool of_thumb, std::string_view joint,
            double rest, double sigma);

  double motion_factor_;
  std::size_t angles_ = 0;
  std::vector<LinearResidual> residuals_;
};

}  // namespace hypotrack::plausible_motion
