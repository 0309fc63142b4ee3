#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "frame_residuals.hpp"
#include "hypotrack/plugin/objective.hpp"

namespace hypotrack::plausible_motion {

/// Prior that keeps fingers plausible which no camera sees. The cost is
///
///   sum over joint angles a         ((a - a_start) / motion_sigma)^2
/// + sum over fingers but the thumb  ((last - coupling * middle) / coupling_sigma)^2
///                                   + ((middle - curl * knuckle) / curl_sigma)^2
///                                   + (abduction / abduction_sigma)^2
/// + sum over fingers side by side   ((knuckle - that of the other) / neighbor_sigma)^2
/// + sum over joints of thumbs       ((angle - that of a relaxed hand) / thumb_sigma)^2
///
/// a_start is the angle at which the frame's search starts (Observation::start). `knuckle`,
/// `middle` and `last` are the flexions of a finger's joints. Tendons bend the last joint by about
/// two thirds of the middle one (H. Rijpkema, M. Girard, Computer animation of knowledge-based
/// human grasping, 1991). A finger mostly opens or closes as a whole, together with those beside
/// it. Thumbs and abductions are pulled to their usual angles. Positions and rotations of models
/// are free.
///
/// Fixed-lag smoothing has its own motion prior, so the first sum is left out there. The residuals
/// are the squared terms. Looks at the state only and needs no rendering.
class PlausibleMotion : public Objective, public ResidualTerm {
 public:
  using Params = PlausibleMotionParams;
  PlausibleMotion(const Params& params, const Scene& scene) : residuals_(params, scene) {}

 protected:
  bool do_needs_rendering() const override { return false; }
  ImageUse do_image_use() const override { return {.color = false, .mask = false, .depth = false}; }
  void do_prepare(const Observation& observation) override;
  double do_cost(const RenderedHypothesis& hypothesis) const override;
  std::unique_ptr<cuda::DeviceObjective> do_on_device() const override;

  const ResidualTerm* do_residual_term() const override { return this; }
  std::int64_t do_residual_count() const override { return term_.count; }
  void do_write_residuals(const RenderedHypothesis& hypothesis,
                          std::span<float> residuals) const override;
  double do_cost_and_residuals(const RenderedHypothesis& hypothesis,
                               std::span<float> residuals) const override;
  bool do_has_jacobian() const override { return true; }
  void do_write_jacobian(const RenderedHypothesis& hypothesis, std::span<float> residuals,
                         Jacobian& jacobian) const override;

 private:
  FrameResiduals residuals_;
  MotionTerm term_{};
};

}  // namespace hypotrack::plausible_motion
