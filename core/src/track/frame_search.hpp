#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "cost/evaluator.hpp"
#include "hypotrack/export.hpp"
#include "hypotrack/frame.hpp"
#include "hypotrack/optimizer.hpp"
#include "tile/tiles.hpp"
#include "track/color/photometric.hpp"
#include "track/search_space.hpp"
#include "track/tracker_parts.hpp"

namespace hypotrack {

/// The answer of a search.
struct Found {
  Eigen::VectorXd state;
  double cost = 0;
  std::int64_t evaluations = 0;
};

/// Searches one frame with the scene's optimizer and objective: cuts tiles around a start, matches
/// colours, minimises.
class HYPOTRACK_API FrameSearch {
 public:
  /// Takes the optimizer and settings of a tracker's parts. The scene must outlive it. Throws
  /// DeviceError if the optimizer needs a GPU and the scene is not evaluated on one.
  FrameSearch(const Scene& scene, TrackerParts& parts);

  /// Draws and learns from these models only from now on, and searches for those of them that are
  /// `moving` (empty: all): one flag per model, any of them set. What states have of the others
  /// stays; where they are not shown it does not count.
  void show(const std::vector<bool>& models, const std::vector<bool>& moving = {});
  const std::vector<bool>& shown() const { return shown_; }
  /// The state with the models that are not shown where nothing draws them.
  Eigen::VectorXd drawn(Eigen::VectorXd state) const;

  /// Takes a frame in for searches that begin at `start`, or near it (Observation::start_is_guess).
  void look(const Frame& frame, const Eigen::VectorXd& start, bool is_guess);

  /// Takes a frame in through tiles of a plan of one's own, with colours matched.
  void take_in(const TileMaker& tiles, const Frame& frame, TilePlan plan);

  /// Costs of some states (DxN) in the frame as it is taken in.
  Eigen::VectorXd costs(Eigen::MatrixXd states);
  /// The cheapest of them.
  Eigen::VectorXd cheapest(const Eigen::MatrixXd& states);

  /// Searches the frame as it is taken in.
  Found from(const Eigen::VectorXd& prior, const Budget& budget, const std::optional<Reach>& reach,
             std::uint64_t seed);

  /// Searches the frame as it is taken in, again from each answer until that gains little.
  Found settled(const Eigen::VectorXd& start, const Budget& budget, std::uint64_t seed);

  /// Begins at a guess: searches, learns colours anew where that ended, and searches again with a
  /// share `search.second_look` of the budget.
  Found from_guess(const Frame& frame, const Eigen::VectorXd& start, const Budget& budget,
                   std::uint64_t seed);

  /// Learns colours from a frame, taken in last, in which the shown models were surely found.
  void learn(const Frame& frame, const Eigen::VectorXd& state);
  void forget_colors() { photometric_.forget(); }

  /// What the frame taken in last shows, with highlights.
  Observation seen(const Frame& frame) const;

  std::int64_t default_evaluations() const { return optimizer_->default_evaluations(); }
  const TileMaker& tiles() const { return tiles_; }
  Evaluator& evaluator() { return evaluator_; }
  const Evaluator& evaluator() const { return evaluator_; }
  const PhotometricMatch& photometric() const { return photometric_; }
  /// What makes the second view's colours the first's.
  ColorMap second_view_colors() const { return photometric_.colors(1); }

 private:
  Eigen::Vector3d some_position(const Eigen::VectorXd& state) const;

  const Scene& scene_;
  SearchSettings settings_;
  Eigen::Vector3d nowhere_;  ///< behind the first camera: what is there is not drawn
  std::vector<bool> shown_, moving_;
  TileMaker tiles_;
  PhotometricMatch photometric_;
  SearchSpace space_;
  Evaluator evaluator_;
  std::unique_ptr<Optimizer> optimizer_;
  TilePlan plan_;  ///< of the last frame
};

}  // namespace hypotrack
