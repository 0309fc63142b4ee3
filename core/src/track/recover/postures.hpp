#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/plugin/model.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Postures to try for a model: limbs straight or bent in many combinations, and postures seen
/// before. A posture is a model's parameters after its pose.
class Postures {
 public:
  explicit Postures(const ModelData& model);

  /// Remembers the posture of a parameter vector unless it resembles a remembered one.
  void remember(const Eigen::VectorXd& parameters);

  /// Returns all postures, at least one. A rigid model has one of length 0.
  const std::vector<Eigen::VectorXd>& all() const { return all_; }

  /// The parameters that bend one limb, and their values if it is straight, half bent or
  /// bent.
  struct Limb {
    std::vector<int> parameters;
    std::vector<Eigen::VectorXd> variants;
  };
  const std::vector<Limb>& limbs() const { return limbs_; }

 private:
  std::vector<Eigen::VectorXd> all_;
  std::vector<Limb> limbs_;
  std::size_t fixed_ = 0;     ///< number of built-in postures, which come first
  std::size_t replaced_ = 0;  ///< index, after those, of the next posture to replace
};

}  // namespace internal
}  // namespace hypotrack
