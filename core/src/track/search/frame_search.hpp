#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/exported.hpp"
#include "cost/fallback_cost.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/plugin/optimizer.hpp"
#include "hypotrack/plugin/output.hpp"
#include "tile/tiles.hpp"
#include "track/color/photometric.hpp"
#include "track/color/still_background.hpp"
#include "track/occlude/hidden_views.hpp"
#include "track/search/optimizer_trace.hpp"
#include "track/search/search_space.hpp"
#include "track/tracker_parts.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

class SearchCost;

/// The result of a search.
struct Found {
  Eigen::VectorXd state;
  double cost = 0;
  std::int64_t evaluations = 0;
};

/// Searches one frame with the scene's optimizer and objective: cuts tiles around a start, matches
/// colours, minimises.
class FrameSearch {
 public:
  /// Moves the optimizer out of `parts` and copies its settings. The scene must outlive the search.
  /// Throws DeviceError if the optimizer needs a GPU and the scene is not evaluated on one.
  FrameSearch(const Scene& scene, TrackerParts& parts);

  /// Restricts drawing and learning to `models`, and searches to those of them that are `moving`
  /// (empty: all). Both have one flag per model; any of `models` must be set. States keep their
  /// values of the other models, which are meaningless where those are not shown.
  void show(const std::vector<bool>& models, const std::vector<bool>& moving = {});
  const std::vector<bool>& shown() const { return shown_; }
  /// Returns the state with the models that are not shown moved behind the camera, where nothing
  /// draws them.
  Eigen::VectorXd drawn(Eigen::VectorXd state) const;

  /// Remembers the answer of a frame for later ones. Null: the models are forgotten.
  void remember(std::shared_ptr<PreviousSolution> answer, const Frame* frame = nullptr);

  /// Sets what hides the models in the frames looked at from now on; null: nothing.
  void hide(std::shared_ptr<const HiddenViews> hidden) { hidden_ = std::move(hidden); }

  /// Prepares a frame for searches from `start`. `is_guess` sets FrameContext::start_is_guess.
  void look(const Frame& frame, const Eigen::VectorXd& start, bool is_guess);

  /// Prepares a frame with the caller's tile plan, with colours matched.
  void take_in(const TileMaker& tiles, const Frame& frame, TilePlan plan);

  /// Returns the costs of states (DxN) in the prepared frame.
  Eigen::VectorXd costs(Eigen::MatrixXd states);
  /// Returns the cheapest of states (DxN) in the prepared frame.
  Eigen::VectorXd cheapest(const Eigen::MatrixXd& states);

  /// Lets searches add themselves to `record`, which must outlive them; null: no more.
  void record(std::vector<RecordedSearch>* record) { record_ = record; }
  /// Lets searches of `frame` add to `trace` how they converge. Both must outlive them; null: no
  /// more.
  void trace(FrameTrace* trace, const Frame* frame);
  /// Returns the cost of the true state in the prepared frame, while searches are traced. NaN if it
  /// is unknown, or a model that is shown is known to be out of view.
  double truth_cost();

  /// Searches the prepared frame once, from `prior`. The first search of a frame starts where an
  /// objective refined the start (Objective::refined_start()).
  Found from(const Eigen::VectorXd& prior, const Budget& budget, const std::optional<Reach>& reach,
             std::uint64_t seed);

  /// Searches the prepared frame repeatedly, each time from the last result, until the cost hardly
  /// falls.
  Found settled(const Eigen::VectorXd& start, const Budget& budget, std::uint64_t seed);

  /// Searches from a guess, relearns the colours at the result, and searches again with the share
  /// `search.second_search` of the budget.
  Found from_guess(const Frame& frame, const Eigen::VectorXd& start, const Budget& budget,
                   std::uint64_t seed);

  /// Learns colours from the frame prepared last. The shown models' poses must be surely right.
  void learn(const Frame& frame, const Eigen::VectorXd& state);
  void forget_colors() { photometric_.forget(); }
  /// Takes by how much each view became brighter since the last frame.
  void follow_brightness(std::span<const float> gains) { photometric_.follow(gains); }

  /// Returns the tiles of the frame prepared last, with highlights.
  Observation seen(const Frame& frame) const;
  /// Returns the tiles of the frame prepared last as the terms got them.
  Observation prepared(const Frame& frame) const { return tiles_.resample(frame, plan_); }

  std::int64_t default_evaluations() const { return optimizer_->default_evaluations(); }
  const TileMaker& tiles() const { return tiles_; }
  /// Returns the cost of the prepared frame's states.
  Cost& cost() const { return *cost_; }
  /// Searches on the CPU after an error of the device, which is being handled, or throws it again.
  void leave_device(const DeviceError& error) { cost_.leave_device(error); }
  bool is_on_gpu() const { return cost_->is_on_gpu(); }
  /// Returns why the device was left; empty: it was not.
  const std::string& device_error() const { return cost_.device_error(); }
  const PhotometricMatch& photometric() const { return photometric_; }
  /// Returns the map from the second view's colours to the first's.
  ColorMap second_view_colors() const { return photometric_.colors(1); }

 private:
  /// Calls the optimizer and checks its answer. Throws PluginError, naming it.
  OptimizerResult minimize(SearchCost& cost, const SearchRegion& region, const Budget& budget,
                           std::uint64_t seed);
  /// Returns where the first search after look() starts: a prior, or what an objective made of it.
  Eigen::VectorXd refined(const Eigen::VectorXd& prior);
  /// Writes the previous answer into a plan, unless it must not assume a motion.
  void add_previous(const Frame& frame, TilePlan& plan) const;
  /// Writes what hides the models into a plan.
  void add_hidden(TilePlan& plan) const;
  Eigen::Vector3d some_position(const Eigen::VectorXd& state) const;

  const Scene& scene_;
  SearchSettings settings_;
  Eigen::Vector3d nowhere_;  ///< a point behind the first camera, which is not drawn
  std::vector<bool> shown_, moving_;
  TileMaker tiles_;
  PhotometricMatch photometric_;
  SearchSpace space_;
  std::optional<StillBackground> background_;  ///< if any term reads it
  std::vector<ObjectiveTerm> terms_;
  bool is_fresh_ = false;  ///< no search was made since look()
  FallbackCost cost_;
  std::unique_ptr<Optimizer> optimizer_;
  SearchClock clock_;
  bool keeps_tiles_;                                  ///< a term reads tiles of `previous_`
  std::shared_ptr<const PreviousSolution> previous_;  ///< null: none
  std::shared_ptr<const HiddenViews> hidden_;         ///< null: nothing
  FrameContext context_;                              ///< of the prepared frame
  TilePlan plan_;                                     ///< of the last frame
  std::vector<RecordedSearch>* record_ = nullptr;     ///< receives searches; null: nothing does
  FrameTrace* trace_ = nullptr;                       ///< the same
  const GroundTruth* truth_ = nullptr;                ///< of the traced frame; null: unknown
};

}  // namespace internal
}  // namespace hypotrack
