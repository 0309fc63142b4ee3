#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hand_finder.hpp"
#include "hypotrack/plugin/objective.hpp"
#include "hypotrack/plugin/plugin_object.hpp"
#include "params.hpp"
#include "side_check.hpp"
#include "sight_term.hpp"

namespace hypotrack::landmarks {

/// Pulls hands to where a learned detector sees their landmarks in the pictures. The cost is
///
///   sum over hands and landmarks, mean over views with colour, of  w^p * s^2 / (1 + s^2),
///   s = max(0, distance - free) / sigma.
///
/// `distance` is how far the landmark is beside the line of sight of the detected one, measured
/// where an average hand looks as large as the detected one. So it does not depend on focal lengths
/// and tiles, and a hand gains nothing by coming nearer. w is the detector's probability of a hand,
/// p is presence_power. The bounded penalty is that of S. Geman and D. McClure (Bayesian image
/// analysis, 1985): a landmark that was detected elsewhere pulls little.
///
/// A hand gets the detection of its side (left or right) next to where the search starts. Without
/// one it costs nothing, as other models do. Residuals are two per view, hand and landmark. Needs
/// no rendering.
class Landmarks : public Objective, public ResidualTerm {
 public:
  using Params = LandmarksParams;

  /// The scene must outlive it. The detector is not asked if no model of the scene is a hand.
  Landmarks(const Params& params, const Scene& scene, Detector detector, PluginLog log = {});

 protected:
  bool do_needs_rendering() const override { return false; }
  ImageUse do_image_use() const override { return {.mask = false, .depth = false}; }
  void do_prepare(const Observation& observation) override;
  double do_cost(const RenderedHypothesis& hypothesis) const override;

  const ResidualTerm* do_residual_term() const override { return this; }
  std::int64_t do_residual_count() const override { return landmarks::residual_count(sights_); }
  void do_write_residuals(const RenderedHypothesis& hypothesis,
                          std::span<float> residuals) const override;
  double do_cost_and_residuals(const RenderedHypothesis& hypothesis,
                               std::span<float> residuals) const override;
  /// Returns false if a hand poses itself.
  bool do_has_jacobian() const override;
  void do_write_jacobian(const RenderedHypothesis& hypothesis, std::span<float> residuals,
                         Jacobian& jacobian) const override;

 private:
  struct Hand {
    const Scene::Item* item;
    HandModel model;
    hands::SideCheck side{8};
  };

  /// Returns each hand at the start of the search and in the last frame.
  std::vector<ModelHand> model_hands(const Observation& observation) const;
  /// Returns whether another model's hand lies over a model's hand in a view.
  bool overlaps_another(const Observation& observation, const TileCamera& camera,
                        const std::vector<ModelHand>& models, std::size_t hand) const;
  /// Warns if all these views show a hand of the other side where a model is.
  void check_sides(const Observation& observation, const std::vector<std::size_t>& views,
                   const std::vector<ModelHand>& models);
  void take_hand(HandSights& sights, const HandModel& model, const TileCamera& camera,
                 const std::optional<SeenHand>& seen) const;

  Params params_;
  PluginLog log_;
  const Scene& scene_;
  std::vector<Hand> hands_;
  HandFinder finder_;
  std::vector<HandSights> sights_;  // one per hand
};

/// Returns the networks as a Detector that looks at whole tiles; an empty one if no model of the
/// scene is a hand. Throws DataError as HandDetector does.
Detector networks(const LandmarksParams& params, const Scene& scene);

}  // namespace hypotrack::landmarks
