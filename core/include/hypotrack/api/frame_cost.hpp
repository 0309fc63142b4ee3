#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/export.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/optimizer.hpp"

namespace hypotrack {

/// The cost that a tracker minimises, of any states in one frame. Session::frame_cost() makes one.
/// Use it from one thread at a time; batches are evaluated in parallel.
class HYPOTRACK_API FrameCost {
 public:
  FrameCost(FrameCost&&) noexcept;
  FrameCost& operator=(FrameCost&&) noexcept;
  ~FrameCost();

  /// Prepares a frame: cuts the tiles around the scene in the state `around`, matches colours there
  /// and prepares all terms. Frames do not learn from each other. The frame's pictures must stay as
  /// they are until the next call. Throws DataError if the frame does not fit the cameras or they
  /// do not see the state, ConfigError on an invalid state.
  void look(const Frame& frame, const Eigen::VectorXd& around);

  /// Returns the weighted sums of the terms (N) for states (DxN, N >= 1); +infinity is infeasible.
  /// Throws Error if no frame is prepared, or if a state has another length or is not finite.
  Eigen::VectorXd costs(const Eigen::Ref<const Eigen::MatrixXd>& states);
  /// Returns each term without its weight (TxN), in the order of term_names().
  Eigen::MatrixXd terms(const Eigen::Ref<const Eigen::MatrixXd>& states);

  /// Returns the residuals (MxN) of states (DxN), each times the root of its term's weight. Throws
  /// ConfigError if the objective has none (least_squares()), and as costs().
  Eigen::MatrixXf residuals(const Eigen::Ref<const Eigen::MatrixXd>& states);
  /// Returns the central differences of residuals() at a state (D) as columns (MxD): one per
  /// parameter, over `steps` (D) to each side. Where a step is 0, the column is 0.
  Eigen::MatrixXf jacobian(const Eigen::VectorXd& state, const Eigen::VectorXd& steps);
  /// Returns the analytic normal equations at a state, per unit of the parameters. `steps` (D) are
  /// those by which surfaces are posed beside it, `blur` is in pixels (ResidualCost::linearize()).
  NormalEquations linearize(const Eigen::VectorXd& state, const Eigen::VectorXd& steps,
                            double blur = 1);

  /// Returns whether the objective has residuals.
  bool least_squares() const;
  /// Returns whether linearize() works.
  bool can_linearize() const;
  /// Returns the names and weights of the terms.
  const std::vector<std::string>& term_names() const;
  const std::vector<double>& weights() const;
  const Scene& scene() const;
  const std::vector<Camera>& cameras() const;
  /// Describes what evaluates: the CPU and its threads, or the GPU.
  std::string backend() const;

 private:
  friend class Session;
  struct Impl;
  explicit FrameCost(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace hypotrack
