#pragma once

#include <memory>
#include <span>
#include <string>

#include "collision_plan.hpp"
#include "hypotrack/plugin/objective.hpp"
#include "hypotrack/plugin/params.hpp"

namespace hypotrack::interpenetration {

struct InterpenetrationParams {
  double tolerance = 0.003;
  bool within_models = true;
  void visit(ParamVisitor& v) {
    v("tolerance_mm", tolerance,
      {.help = "depth that costs nothing: skin gives way, and capsules are no hands",
       .min = 0,
       .max = 1000,
       .unit = "mm",
       .to_si = kMillimetre});
    v("within_models", within_models,
      {.help =
           "also between bones of one model that are no neighbours (fingers, fingers and palm)"});
  }
};

/// Keeps fingers, hands and objects from passing through each other. Capsules fill every bone of
/// every model; a box fills a rigid box (bone_shapes()). The cost is the sum of squared depths
/// (mm^2) over all pairs of shapes, where
///
///   depth = max(0, penetration - tolerance - penetration at rest).
///
/// The last term is only for pairs within a model, so that the rest pose costs nothing. The depths
/// are the residuals, one per pair. Looks at the state only and needs no rendering.
class Interpenetration : public Objective, public ResidualTerm {
 public:
  /// `where` is the place of the parameters in messages. Throws ConfigError where CollisionPlan
  /// does.
  Interpenetration(const InterpenetrationParams& params, const Scene& scene,
                   const std::string& where = "interpenetration");

  const CollisionPlan& plan() const { return plan_; }

 protected:
  bool do_needs_rendering() const override { return false; }
  ImageUse do_image_use() const override { return {.color = false, .mask = false, .depth = false}; }
  void do_prepare(const Observation&) override {}
  double do_cost(const RenderedHypothesis& hypothesis) const override;
  std::unique_ptr<cuda::DeviceObjective> do_on_device() const override;

  const ResidualTerm* do_residual_term() const override { return this; }
  std::int64_t do_residual_count() const override { return term_.pair_count; }
  void do_write_residuals(const RenderedHypothesis& hypothesis,
                          std::span<float> residuals) const override;
  double do_cost_and_residuals(const RenderedHypothesis& hypothesis,
                               std::span<float> residuals) const override;

 private:
  CollisionPlan plan_;
  CollisionTerm term_;
};

}  // namespace hypotrack::interpenetration
