#pragma once

#include <Eigen/Core>
#include <vector>

#include "hypotrack/export.hpp"
#include "hypotrack/model.hpp"

namespace hypotrack {

/// Postures that a model may be in: limbs straight or bent in many combinations, and those in which
/// it was seen. A posture is a model's parameters after its pose.
class HYPOTRACK_API Postures {
 public:
  explicit Postures(const ModelData& model);

  /// Remembers the posture of a parameter vector if it is unlike those remembered before.
  void remember(const Eigen::VectorXd& parameters);

  /// At least one; a rigid model has one of length 0.
  const std::vector<Eigen::VectorXd>& all() const { return all_; }

  /// The parameters that bend one limb (a finger), and what they may be: straight, half or bent.
  struct Limb {
    std::vector<int> parameters;
    std::vector<Eigen::VectorXd> variants;
  };
  const std::vector<Limb>& limbs() const { return limbs_; }

 private:
  std::vector<Eigen::VectorXd> all_;
  std::vector<Limb> limbs_;
  std::size_t fixed_ = 0;     ///< of them that do not change
  std::size_t replaced_ = 0;  ///< next of the others to be replaced
};

}  // namespace hypotrack
