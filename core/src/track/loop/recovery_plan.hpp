#pragma once

#include <bit>
#include <cstddef>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/frame.hpp"
#include "track/loop/loop_state.hpp"
#include "track/search/candidate_finder.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Takes turns ever more seldom: the first, 2nd, 4th, 8th, ... time.
class RareTurns {
 public:
  /// Counts a time. Returns whether it is a turn.
  bool next() { return std::has_single_bit(++count_); }
  /// Takes a time back, so that turns slowly become less rare.
  void take_back() { count_ -= count_ > 0; }
  void restart() { count_ = 0; }

 private:
  unsigned count_ = 0;
};

/// Decides which models a frame is searched for beyond following them, and with what effort.
class RecoveryPlan {
 public:
  /// Plans the recovery of a frame whose search ended in `best`. The request seeks
  ///  - models without a pose that is right, those with a poor one not in every frame; or else
  ///  - from time to time, one model where detectors may see it elsewhere; or else
  ///  - other poses near doubtful ones, and near all just after a loss.
  /// It seeks no models that are expected at the start, and perhaps none at all. A tracker that
  /// recovers in the background seeks no other poses.
  RecoveryRequest next(LoopState& loop, const Frame& frame, const Candidate& best);

  /// Returns whether a request is for a search in the background: models are lost, none can be
  /// followed meanwhile, and the settings ask for it.
  static bool is_for_background(const LoopState& loop, const RecoveryRequest& request,
                                const Candidate& best);

  void restart();

 private:
  /// Counts a frame of a model whose pose is poor. Returns whether it is followed as it is.
  bool rests(std::size_t model);
  /// Writes into `request` the models that are lost, and all that is known of every model.
  void seek_lost(LoopState& loop, const Frame& frame, const Candidate& best,
                 RecoveryRequest& request);
  /// Seeks a model that detectors may see elsewhere if it is time for that.
  void check_elsewhere(const LoopState& loop, const Frame& frame, RecoveryRequest& request);
  /// Seeks other poses of doubtful models, ever more seldom while there are none.
  void seek_nearby(const LoopState& loop, const Candidate& best, RecoveryRequest& request);

  RareTurns doubtful_finds_;    ///< of models in doubtful first poses, to be looked for elsewhere
  RareTurns doubts_;            ///< of doubtful poses, to be compared with others nearby
  std::vector<unsigned> poor_;  ///< by model: recent frames whose pose was poor
  ModelFlags rests_;        ///< models with poor poses that are followed as they are in this frame
  double checked_ = 0;      ///< time at which detectors last looked for a model elsewhere
  std::size_t checks_ = 0;  ///< number of these checks, which take turns among the models
};

}  // namespace internal
}  // namespace hypotrack
