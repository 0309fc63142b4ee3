#pragma once

#include <Eigen/Core>
#include <string_view>
#include <vector>

#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/observation.hpp"
#include "motion_term.hpp"
#include "params.hpp"

namespace hypotrack::plausible_motion {

/// Makes the residuals of a scene's frames. First comes one per joint angle, then two per finger,
/// one per pair of fingers side by side, one per abduction and one per joint of a thumb.
class FrameResiduals {
 public:
  /// A model has fingers if it has parameters NAME_flexion_1, _2 and _3. The joints of a thumb are
  /// not coupled.
  FrameResiduals(const PlausibleMotionParams& params, const Scene& scene);

  /// Returns the term of a frame, which points into this object until the next call. In fixed-lag
  /// smoothing (FrameContext::no_motion_prior) the residuals of joint motion are 0.
  MotionTerm of(const Observation& observation);

 private:
  /// Adds a residual per finger that has both joints: one flexion should be `share` times the
  /// other.
  void couple(const std::vector<Parameter>& parameters, std::string_view joint,
              std::string_view before, double share, double sigma);
  /// Adds a residual per pair of fingers side by side: their knuckles should bend alike.
  void couple_neighbors(const Scene& scene, double sigma);
  /// Adds a residual per parameter of that name, of fingers or of thumbs: it should be at `rest`.
  void hold(const std::vector<Parameter>& parameters, bool of_thumb, std::string_view joint,
            double rest, double sigma);

  double motion_factor_;
  std::size_t angles_ = 0;
  std::vector<LinearResidual> residuals_;
};

}  // namespace hypotrack::plausible_motion
