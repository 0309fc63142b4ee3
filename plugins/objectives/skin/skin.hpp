#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "foreground.hpp"
#include "hypotrack/objective.hpp"
#include "params.hpp"

namespace hypotrack::skin {

/// Agreement of a hypothesis' silhouettes with how likely each pixel is foreground, P:
///
///   cost = mean over views of ( sum over uncovered pixels of P
///                             + spill * sum over covered pixels of (1 - P) )
///
/// in pixels of a tile, as a stereo objective's score is. A hypothesis is rewarded for covering
/// what has the models' colours and pays for lying on what has not, which a comparison of two views
/// cannot see. P comes from the colours under the first frames' poses, from the frame's mask or
/// from its depth (foreground.hpp). All models of a scene are foreground together.
///
/// The cost is a sum of squares: every pixel of a view has the residual sqrt(P) where it is
/// uncovered and sqrt(spill (1 - P)) where it is covered (0 where it is invalid), divided by the
/// root of the number of views.
class Skin : public Objective, public ResidualTerm {
 public:
  using Params = skin::Params;

  explicit Skin(const Params& params);

  ImageUse image_use() const override;
  /// Uses the views that have what the parameters ask for. Throws DataError if none has, and on
  /// images that do not have their tile's size and type.
  void prepare(const Observation& observation) override;
  /// Throws DataError if the drawn tiles are not those of the prepared frame.
  double cost(const RenderedHypothesis& hypothesis) const override;
  std::unique_ptr<cuda::DeviceObjective> on_device() const override;

  const ResidualTerm* residual_term() const override { return this; }
  std::int64_t residual_count() const override;
  /// Both throw DataError as cost().
  void write_residuals(const RenderedHypothesis& hypothesis,
                       std::span<float> residuals) const override;
  double cost_and_residuals(const RenderedHypothesis& hypothesis,
                            std::span<float> residuals) const override;
  bool has_slopes() const override { return true; }
  std::span<const int> pixel_views() const override { return view_numbers_; }
  /// All slopes are 0: what matters is whether a pixel is covered, not how far away. Throws
  /// DataError as cost().
  void write_slopes(const RenderedHypothesis& hypothesis, std::size_t i, std::span<float> residuals,
                    std::span<float> slopes) const override;

 private:
  struct PreparedView {
    std::size_t index;  ///< among the observation's views
    ViewForeground foreground;
    PixelPlane<float> uncovered;  ///< residuals where nothing is covered
  };

  /// Writes the residuals of one view's pixels and returns its part of the cost.
  double measure(const PreparedView& view, const RenderedHypothesis& hypothesis,
                 std::span<float> residuals) const;
  float share() const;  ///< of each view

  Params params_;
  std::vector<ForegroundTeller> tellers_;  ///< one per view of the observation
  std::vector<PreparedView> views_;
  std::vector<int> view_numbers_;  ///< of views_
};

}  // namespace hypotrack::skin
