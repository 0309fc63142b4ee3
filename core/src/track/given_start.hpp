#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/scene.hpp"

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

  /// Returns the mean distance of a model's landmarks in a state from those at the start, metres.
  double distance(std::size_t model, const Eigen::VectorXd& state) const;

  /// Returns whether the search of a frame has left the start so far that the model may have
  /// another posture.
  bool is_left(std::size_t model, const Eigen::VectorXd& found) const;

  /// Returns the probability of a pose for which the search left the start, by that in the
  /// pictures: a start of another moment leads to poses that look right.
  static double doubted(double probability);

  /// Stops to expect a model at the start. `why` is a clause of the note to the user.
  void contradict(int frame, std::size_t model, const std::string& why);
  /// Tells the user that another pose was found near the start.
  void note(int frame, std::size_t model, const std::string& what);

  /// Returns the notes since the last call, one per model at most.
  std::vector<std::string> take_notes();

 private:
  const Scene& scene_;
  Eigen::VectorXd state_;
  std::vector<bool> expected_, noted_;  ///< by model
  std::vector<std::string> notes_;
};

}  // namespace internal
}  // namespace hypotrack
