#pragma once

#include <vector>

#include "base/exported.hpp"
#include "shape/joint_fit.hpp"
#include "shape/shape_targets.hpp"
#include "track/search/search_space.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns whether enough landmarks of a scene are known to say where the wanted models are.
bool place_models(const Scene& scene, const ShapeTargets& targets,
                  const Eigen::Matrix3Xd& landmarks);

/// The sum of squared distances of labelled landmarks over several frames, in units of
/// `kLabelDeviation`. With a prior of weight 1 its minimum is the most probable shape for labels
/// with that standard deviation.
class LandmarkProblem final : public JointProblem {
 public:
  static constexpr double kLabelDeviation = 3e-3;  ///< metres, each axis

  /// `landmarks`: world positions in the order of Scene::landmark_names(), 3xL, one entry per
  /// frame; NaN columns are unknown. The scene must outlive the problem. Throws DataError if a
  /// frame knows fewer than three landmarks of a model whose shape is fitted.
  LandmarkProblem(const Scene& scene, const ShapeTargets& targets,
                  std::vector<Eigen::Matrix3Xd> landmarks);

  /// Returns the initial shape and poses fitted with it. Each pose's fit starts from the one
  /// before.
  JointTrial start() const;
  /// Returns the mean distance over known landmarks and frames, metres.
  double mean_distance(const JointTrial& trial) const;

  std::vector<FrameSystem> systems(const JointTrial& trial) override;
  Eigen::VectorXd costs(const JointTrial& trial) override;
  Eigen::VectorXd moved(const Eigen::VectorXd& pose, const Eigen::VectorXd& step) const override;

 private:
  Eigen::VectorXd residuals(const Scene& scene, std::size_t frame,
                            const Eigen::VectorXd& pose) const;

  const Scene& scene_;
  const ShapeTargets& targets_;
  SearchSpace space_;
  std::vector<Eigen::Matrix3Xd> landmarks_;  // NaN for other models
};

}  // namespace internal
}  // namespace hypotrack
