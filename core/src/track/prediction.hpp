#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/params.hpp"
#include "track/tangent.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Share of the last motion that a prediction extrapolates.
enum class Prediction {
  none,      ///< searches start from the last solution, as in the paper
  constant,  ///< a fixed share
  adaptive,  ///< the share that fits the new frame best
};
std::span<const std::string_view> enum_names(Prediction);

/// `search.prediction:` of a scene.
struct PredictionSettings {
  Prediction velocity = Prediction::none;
  double gain = 0.5;
  double longest_gap = 0.3;
  void visit(ParamVisitor& v) {
    v("velocity", velocity,
      {.help = "share of the last motion that continues: none; constant: `gain`; adaptive: none, "
               "half or all of it, whichever fits the new frame best, separately for poses and "
               "joint angles, for nine evaluations of the frame's budget"});
    v("gain", gain,
      {.help = "for velocity: constant, the share of the last motion that continues",
       .min = 0,
       .max = 1});
    v("longest_gap_ms", longest_gap,
      {.help = "no prediction across longer gaps between frames",
       .min = 0,
       .max = 1e6,
       .unit = "ms",
       .to_si = 1e-3});
  }
};

/// Extrapolates a part of the last motion to predict the next state. Motion is a difference of
/// tangent.hpp.
class Predictor {
 public:
  /// The scene must outlive the predictor.
  Predictor(const Scene& scene, const PredictionSettings& settings);

  /// Returns predicted states (DxN, normalised) at a time (s), the middle one first. There is one
  /// or, for an adaptive share, nine; none if the motion is unknown or the gap too long.
  Eigen::MatrixXd at(double time) const;

  /// Adds a solution (normalised) and its time (s), in the order of time.
  void add(const Eigen::VectorXd& state, double time);

  /// Forgets all solutions: the next one is the first.
  void begin_anew() { state_.resize(0); }

  /// Forgets the motion, because the last solution does not continue those before.
  void forget_motion() { velocity_.reset(); }

  /// Returns the last motion per second, a difference of tangent.hpp; nothing if unknown.
  const std::optional<Eigen::VectorXd>& velocity() const { return velocity_; }

 private:
  bool is_gap(double seconds) const;
  Eigen::VectorXd led(double seconds, double pose_share, double angle_share) const;

  const Scene* scene_;
  PredictionSettings settings_;
  std::vector<TangentPart> parts_;
  Eigen::VectorXd state_;
  double time_ = 0;
  std::optional<Eigen::VectorXd> velocity_;  ///< per second
};

}  // namespace internal
}  // namespace hypotrack
