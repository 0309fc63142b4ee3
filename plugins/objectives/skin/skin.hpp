#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "foreground.hpp"
#include "hypotrack/plugin/objective.hpp"
#include "params.hpp"

namespace hypotrack::skin {

/// Compares a hypothesis' silhouettes with the foreground probability P of each pixel:
///
///   cost = mean over views of ( sum over uncovered pixels of P
///                             + spill * sum over covered pixels of (1 - P) )
///
/// in pixels of a tile, as the score of a stereo objective. Covering pixels of the models' colours
/// is rewarded and covering other pixels is charged, which a comparison of two views cannot do. P
/// comes from the colours under the first frames' poses, from the frame's mask or from its depth
/// (foreground.hpp). All models of a scene are one foreground.
///
/// The cost is a sum of squares. A pixel of a view has the residual sqrt(P) if it is uncovered,
/// sqrt(spill (1 - P)) if it is covered and 0 if it is invalid, each divided by the root of the
/// number of views.
class Skin : public Objective, public ResidualTerm {
 public:
  using Params = skin::Params;

  explicit Skin(const Params& params);

 private:
  ImageUse do_image_use() const override;
  /// Uses the views that have what the parameters need. Throws DataError if none has, and on images
  /// without their tile's size and type.
  void do_prepare(const Observation& observation) override;
  /// Throws DataError if the drawn tiles are not those of the prepared frame.
  double do_cost(const RenderedHypothesis& hypothesis) const override;
  std::unique_ptr<cuda::DeviceObjective> do_on_device() const override;

  const ResidualTerm* do_residual_term() const override { return this; }
  std::int64_t do_residual_count() const override;
  /// Writes the residuals. Throws DataError as cost() does, like cost_and_residuals().
  void do_write_residuals(const RenderedHypothesis& hypothesis,
                          std::span<float> residuals) const override;
  double do_cost_and_residuals(const RenderedHypothesis& hypothesis,
                               std::span<float> residuals) const override;
  bool do_has_slopes() const override { return true; }
  std::span<const int> do_pixel_views() const override { return view_numbers_; }
  /// Writes slopes of 0: the residual depends on whether a pixel is covered, not on its depth.
  /// Throws DataError as cost() does.
  void do_write_slopes(const RenderedHypothesis& hypothesis, std::size_t i,
                       std::span<float> residuals, std::span<float> slopes) const override;

  struct PreparedView {
    std::size_t index;  ///< among the observation's views
    ViewForeground foreground;
    PixelPlane<float> uncovered;  ///< residuals of uncovered pixels
  };

  /// Writes the residuals of one view's pixels and returns its part of the cost.
  double measure(const PreparedView& view, const RenderedHypothesis& hypothesis,
                 std::span<float> residuals) const;
  float share() const;  ///< weight of each view

  Params params_;
  std::vector<ForegroundEstimator> estimators_;  ///< one per view of the observation
  std::vector<PreparedView> views_;
  std::vector<int> view_numbers_;  ///< indices of views_ among the observation's
};

}  // namespace hypotrack::skin
