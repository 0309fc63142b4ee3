#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/scene.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Models are expected at the start that was given until something contradicts it: a start of
/// another moment leads to a wrong pose that fits somehow. Contradicted models are looked for in
/// the pictures, as without a start.
class GivenStart {
 public:
  /// `state`: the state that was given. `is_given` is false for any state in view.
  GivenStart(const Scene& scene, Eigen::VectorXd state, bool is_given);

  const Eigen::VectorXd& state() const { return state_; }

  /// Returns whether a model is expected at the start.
  bool expects(std::size_t model) const { return expected_[model]; }
  bool expects_any() const;

  /// Counts a search from the start. Returns the number of those before.
  int count_search() { return searches_++; }
  /// Returns whether so few were made that only a likely pose is believed.
  bool is_early() const;

  /// Returns the mean distance of a model's landmarks in a state from those at the start, metres.
  double distance(std::size_t model, const Eigen::VectorXd& state) const;

  /// Returns whether the search of a frame has left the start so far that the model may have
  /// another posture.
  bool is_left(std::size_t model, const Eigen::VectorXd& found) const;

  /// Returns the probability of a pose that the start led to and that other searches did not
  /// reproduce, by that in the pictures: a start of another moment leads to poses that look right.
  static double doubted(double probability);

  /// Remembers what speaks against the start. `why` is a clause of the note to the user.
  void doubt(std::size_t model, const std::string& why) { doubts_[model] = why; }
  /// Stops expecting a model at the start, for a reason as of doubt().
  void contradict(std::size_t model, const std::string& why);
  /// Notes doubts of this frame for the user, unless the model was surely found about at the start.
  void conclude(int frame, std::size_t model, const Eigen::VectorXd& state, bool is_found);

  /// Returns the notes since the last call, one per model at most.
  std::vector<std::string> take_notes();

 private:
  const Scene& scene_;
  Eigen::VectorXd state_;
  std::vector<bool> expected_, noted_;  ///< by model
  std::vector<std::string> doubts_;     ///< by model; empty: none
  std::vector<std::string> notes_;
  int searches_ = 0;
};

}  // namespace internal
}  // namespace hypotrack
