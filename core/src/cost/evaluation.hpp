#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "cost/evaluator.hpp"
#include "tile/tiles.hpp"

namespace hypotrack {

/// How hypotheses become costs: the seam between the evaluator and its backends.
class Evaluation {
 public:
  Evaluation() = default;
  virtual ~Evaluation() = default;
  Evaluation(const Evaluation&) = delete;
  Evaluation& operator=(const Evaluation&) = delete;

  /// Takes a frame in, for the terms as well. The observation outlives every use until the next
  /// `prepare`.
  virtual void prepare(const Observation& observation) = 0;

  /// The same for a frame that its terms have taken in already, for another evaluation of them.
  virtual void prepare_drawing(const Observation& observation) { prepare(observation); }

  /// The same for a frame whose tiles are not cut yet. Frame and plan outlive every use until the
  /// next `prepare`.
  virtual void prepare(const TileMaker& tiles, const Frame& frame, const TilePlan& plan) {
    cut_ = tiles.cut(frame, plan);
    prepare(cut_);
  }

  /// Weighted sums of the terms (N) for normalised states (DxN). Throws by refuse_cost() if one is
  /// NaN.
  virtual void evaluate(const Eigen::MatrixXd& states, Eigen::Ref<Eigen::VectorXd> costs) = 0;

  /// Whether it has residuals: the terms are a sum of squares, and this backend computes them.
  virtual bool has_residuals() const { return false; }
  /// Residuals of every hypothesis of the prepared frame.
  virtual Eigen::Index residual_count() const { return 0; }
  /// Evaluator::pose_only_residuals().
  virtual std::vector<ResidualRows> pose_only_residuals() const { return {}; }
  /// The costs and the residuals (residual_count() x N); only where has_residuals().
  virtual void evaluate_residuals(const Eigen::MatrixXd& states,
                                  Eigen::Ref<Eigen::MatrixXf> residuals,
                                  Eigen::Ref<Eigen::VectorXd> costs);

  /// Residuals that stay where they are computed, for normalised states; null where
  /// evaluate_residuals() is as good.
  virtual ResidualDifferences* differences() { return nullptr; }

  /// See ResidualCost, for normalised states.
  virtual bool can_linearize() const { return false; }
  virtual NormalEquations linearize(const Eigen::MatrixXd& states, const Eigen::VectorXd& steps,
                                    double blur);

  /// For Evaluator::backend(): `cpu (AVX3, 2 threads)`.
  virtual std::string description() const = 0;

  /// Whether device_cost() is there.
  virtual bool on_device() const { return false; }
  /// Costs of search points on the device (see Evaluator::device_cost); null on the host.
  virtual cuda::DeviceCost* device_cost(const Eigen::VectorXd&, bool) { return nullptr; }

 private:
  Observation cut_;
};

/// The backend that the settings ask for. Throws DeviceError if it is not to be had; never a silent
/// substitute. The scene outlives it. Throws ConfigError if the terms or the backend do not have
/// what is wanted of them.
std::unique_ptr<Evaluation> make_evaluation(const Scene& scene,
                                            const std::vector<ObjectiveTerm>& terms,
                                            const EvaluateSettings& settings,
                                            const ResidualUse& use);

/// Draws with a HypothesisRenderer and asks the terms on the CPU. `why_here`: the reason why it is
/// not on a GPU, for its description().
std::unique_ptr<Evaluation> make_host_evaluation(const Scene& scene,
                                                 const std::vector<ObjectiveTerm>& terms,
                                                 const EvaluateSettings& settings,
                                                 std::string why_here = {});

/// Why `backend: auto` evaluates these terms on the CPU; empty if it does so on the GPU.
std::string why_automatic_on_cpu(const Scene& scene, const std::vector<ObjectiveTerm>& terms,
                                 const EvaluateSettings& settings, const ResidualUse& use);

/// Throws Error: what a term did wrong (`returned NaN`) for a hypothesis.
[[noreturn]] void refuse_cost(const ObjectiveTerm& term, Eigen::Index index, const char* what);

namespace cuda {

/// Why these terms of this scene cannot be evaluated on the GPU of the settings, with `residuals`
/// if they are asked for; empty if they can.
std::string why_not_evaluated(const Scene& scene, const std::vector<ObjectiveTerm>& terms,
                              const EvaluateSettings& settings, bool residuals);

/// Poses, draws and scores on the GPU. Throws DeviceError where why_not_evaluated() has a reason.
std::unique_ptr<Evaluation> make_evaluation(const Scene& scene,
                                            const std::vector<ObjectiveTerm>& terms,
                                            const EvaluateSettings& settings, bool residuals);

}  // namespace cuda
}  // namespace hypotrack
