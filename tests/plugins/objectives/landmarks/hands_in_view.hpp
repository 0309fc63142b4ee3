#pragma once

#include <atomic>

#include "landmarks.hpp"

namespace hypotrack::landmarks::test {

/// Returns a scene of the hand, as `hand`, and its mirror image, as `left`.
const Scene& two_hands();

/// Returns a state in which both hands are bent a little, side by side, 0.5 m before the cameras.
Eigen::VectorXd relaxed();

/// Returns the state with a finger bent by radians at its knuckle, such as "hand.index".
Eigen::VectorXd bent(Eigen::VectorXd state, const std::string& finger, double angle);

/// Returns the observation of a search that starts at a state: two black tiles of a stereo pair.
/// Their top left pixels hold the view's index.
Observation observation(const Eigen::VectorXd& start, int frame = 0);

/// A detector that sees hands as they are in a state, and counts how often it looks.
class SeesState {
 public:
  explicit SeesState(Eigen::VectorXd state) : state_(std::move(state)) {}

  /// Returns the functions, which refer to this object. refine() finds what lies at the guess.
  Detector detector();

  double presence = 1;
  bool right = true;                           ///< sees the right hand
  bool left = true;                            ///< sees the left hand
  bool exchanged = false;                      ///< takes right hands for left ones
  std::atomic<int> refined = 0, detected = 0;  ///< views are looked at by several threads
  std::atomic<int> followed = 0;               ///< of those that are refined
  std::atomic<double> farthest_followed = 0;   ///< pixels from a followed guess to the hand
  Observation seen;                            ///< whose tiles it is given

 private:
  std::vector<HandDetection> hands(const cv::Mat& picture) const;

  Eigen::VectorXd state_;
};

/// Returns a hypothesis of a state, which it refers to.
inline RenderedHypothesis hypothesis(const Eigen::VectorXd& state) {
  return {{state.data(), static_cast<std::size_t>(state.size())}, {}};
}

}  // namespace hypotrack::landmarks::test
