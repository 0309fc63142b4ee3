#pragma once

#include <memory>
#include <vector>

#include "cost/evaluator.hpp"
#include "hypotrack/export.hpp"
#include "hypotrack/frame.hpp"
#include "shape/coverage.hpp"
#include "shape/joint_fit.hpp"
#include "shape/shape_targets.hpp"
#include "tile/tiles.hpp"
#include "track/color/photometric.hpp"
#include "track/search_space.hpp"

namespace hypotrack {

/// A frame and the state that a tracker has found for it.
struct TrackedFrame {
  Frame frame;
  Eigen::VectorXd state;
};

/// What a scene's objective says about shapes, in several frames.
struct ImageProblemParts {
  std::vector<Camera> cameras;
  std::vector<ObjectiveTerm> objective;  ///< with residuals
  TileSettings tile;
  PhotometricSettings photometric;
  EvaluateSettings evaluate;
  double coverage = 0;  ///< see ImageProblem
  double edge = 0;      ///< see ImageProblem, pixels of a tile
};

/// The objective of a scene over several frames, by numerical derivatives (central differences of
/// costs for gradients and of residuals for Gauss-Newton's Hessians).
///
/// To the objective it adds a charge on covered pixels (Coverage): `coverage` times what a covered
/// pixel explains on average where the frame's fit begins, which is the cost of a scene out of
/// sight less that of the start, per pixel. A boundary then lies where covering one more pixel
/// explains that share of what the mean one does. With 0.5 that is where S / sqrt(N) of a sum S
/// over N pixels is stationary, too.
///
/// Pixels at the edge of what is seen show some of it and some of what is behind it. The views
/// agree on them only where little of that is, so a silhouette fits best that lies a little inside
/// of the true one. `edge` says how much, in pixels: surfaces are drawn that much farther in, as
/// far as a pixel is wide at the models on average.
class HYPOTRACK_API ImageProblem final : public JointProblem {
 public:
  /// The scene must outlive the problem. Throws ConfigError if the objective has no residuals,
  /// DataError if a frame does not fit the cameras or a start lies at or behind one.
  ImageProblem(const Scene& scene, const ShapeTargets& targets, ImageProblemParts parts,
               std::vector<TrackedFrame> frames);
  ~ImageProblem() override;

  /// The shape and states to start from.
  JointTrial start() const;
  /// Length of the derivatives' steps from now on: 1 moves surfaces by about a millimetre, which
  /// should be a pixel of a tile. Long ones see farther: a pixel counts only if a step makes the
  /// silhouette pass it.
  void set_steps(double length);
  /// What a covered pixel of each frame explains at the start. 0 or less: nothing.
  const std::vector<double>& explained() const { return explained_; }

  std::vector<FrameSystem> systems(const JointTrial& trial) override;
  Eigen::VectorXd costs(const JointTrial& trial) override;
  Eigen::VectorXd moved(const Eigen::VectorXd& pose, const Eigen::VectorXd& step) const override;

 private:
  /// A scene built with one shape, and what evaluates it.
  struct Built {
    std::unique_ptr<Scene> scene;
    std::unique_ptr<Evaluator> evaluator;
  };
  Built built(const Eigen::VectorXd& shape) const;
  void prepare(Evaluator& evaluator, std::size_t frame);
  void measure_explained();
  /// What a pixel of the first view is wide at the models that are looked for, metres, on average.
  double pixel_width() const;
  void add_poses(Evaluator& evaluator, const Eigen::VectorXd& pose, FrameSystem& system,
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

}  // namespace hypotrack
