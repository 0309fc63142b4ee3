#pragma once

#include <memory>
#include <vector>

#include "base/exported.hpp"
#include "cost/cost.hpp"
#include "hypotrack/api/frame.hpp"
#include "shape/coverage.hpp"
#include "shape/joint_fit.hpp"
#include "shape/shape_targets.hpp"
#include "tile/tiles.hpp"
#include "track/color/photometric.hpp"
#include "track/search/search_space.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// A frame and the state that a tracker has found for it.
struct TrackedFrame {
  Frame frame;
  Eigen::VectorXd state;
};

/// Settings and objective of an ImageProblem.
struct ImageProblemParts {
  std::vector<Camera> cameras;
  std::vector<ObjectiveTerm> objective;  ///< with residuals
  TileSettings tile;
  PhotometricSettings photometric;
  EvaluateSettings evaluate;
  double coverage = 0;  ///< see ImageProblem
  double edge = 0;      ///< see ImageProblem, pixels of a tile
};

/// The objective of a scene over several frames as a function of shape and poses. Derivatives are
/// numerical: central differences of costs for gradients, of residuals for Gauss-Newton Hessians.
///
/// It adds a penalty on covered pixels (Coverage): `coverage` times what a covered pixel explains
/// on average where the frame's fit begins. This is the cost with the scene out of view minus that
/// of the start, per pixel. A boundary then lies where one more covered pixel explains that share
/// of the mean. With 0.5 this is also where S / sqrt(N) is stationary, for a sum S over N pixels.
///
/// Pixels at the edge of a surface mix it with the background. The views agree on such pixels only
/// if the background's part is small, so the best silhouette lies a little inside the true one.
/// `edge` is this distance in pixels. Surfaces are drawn that much farther in, by a pixel's mean
/// width at the models.
class ImageProblem final : public JointProblem {
 public:
  /// The scene must outlive the problem. Throws ConfigError if the objective has no residuals,
  /// DataError if a frame does not fit the cameras or a start lies at or behind a camera.
  ImageProblem(const Scene& scene, const ShapeTargets& targets, ImageProblemParts parts,
               std::vector<TrackedFrame> frames);
  ~ImageProblem() override;

  /// Returns the shape and states to start from.
  JointTrial start() const;
  /// Sets the length of the derivatives' steps. 1 moves surfaces by about a millimetre, which
  /// should be a pixel of a tile. Longer steps see farther: a pixel counts only if the silhouette's
  /// edge passes it.
  void set_steps(double length);
  /// Returns what a covered pixel of each frame explains at the start; 0 or less: nothing.
  const std::vector<double>& explained() const { return explained_; }

  std::vector<FrameSystem> systems(const JointTrial& trial) override;
  Eigen::VectorXd costs(const JointTrial& trial) override;
  Eigen::VectorXd moved(const Eigen::VectorXd& pose, const Eigen::VectorXd& step) const override;

 private:
  /// A scene built with one shape, and its cost.
  struct Built {
    std::unique_ptr<Scene> scene;
    std::unique_ptr<Cost> cost;
  };
  Built built(const Eigen::VectorXd& shape) const;
  void prepare(Cost& cost, std::size_t frame);
  void measure_explained();
  /// Returns the mean width in metres of a pixel of the first view at the models in question.
  double pixel_width() const;
  void add_poses(Cost& cost, const Eigen::VectorXd& pose, FrameSystem& system,
                 Eigen::MatrixXf& jacobian);

  const Scene& scene_;
  const ShapeTargets& targets_;
  ImageProblemParts parts_;
  std::vector<TrackedFrame> frames_;
  double steps_ = 1;
  SearchSpace space_;
  std::shared_ptr<Coverage> coverage_;
  std::vector<Observation> observations_;
  std::vector<double> explained_;
  double thinner_ = 0;  // metres
};

}  // namespace internal
}  // namespace hypotrack
