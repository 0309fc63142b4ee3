#pragma once

#include <cstdint>
#include <span>

#include "hypotrack/export.hpp"
#include "hypotrack/objective.hpp"

namespace hypotrack {

/// What a covered pixel of the first view costs. A sum over pixels rewards whoever covers more of
/// them, so that a free size grows; with a charge a pixel is worth covering only if it explains
/// more than that.
class HYPOTRACK_API Coverage final : public Objective, public ResidualTerm {
 public:
  /// Of every covered pixel from now on, >= 0.
  void set_charge(double charge) { charge_ = charge; }
  double charge() const { return charge_; }

  void prepare(const Observation& observation) override;
  double cost(const RenderedHypothesis& hypothesis) const override;
  const ResidualTerm* residual_term() const override { return this; }
  std::int64_t residual_count() const override { return count_; }
  void write_residuals(const RenderedHypothesis& hypothesis,
                       std::span<float> residuals) const override;

 private:
  double charge_ = 0;
  std::int64_t count_ = 0;
};

/// Number of covered pixels of a view.
HYPOTRACK_API std::int64_t covered_pixels(const DepthTile& tile);

}  // namespace hypotrack
