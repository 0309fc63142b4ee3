#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "cost/evaluator.hpp"
#include "tile/tiles.hpp"

namespace hypotrack {

/// Backend interface of the evaluator: turns hypotheses into costs.
class Evaluation {
 public:
  Evaluation() = default;
  virtual ~Evaluation() = default;
  Evaluation(const Evaluation&) = delete;
  Evaluation& operator=(const Evaluation&) = delete;

  /// Prepares the backend and the terms for a frame. The observation outlives every use until the
  /// next `prepare`.
  virtual void prepare(const Observation& observation) = 0;

  /// Prepares for drawing only. Precondition: every term was already prepared with this
  /// observation.
  virtual void prepare_drawing(const Observation& observation) { prepare(observation); }

  /// Prepares a frame from its images and resamples its tiles. Frame and plan outlive every use
  /// until the next `prepare`.
  virtual void prepare(const TileMaker& tiles, const Frame& frame, const TilePlan& plan) {
    cut_ = tiles.cut(frame, plan);
    prepare(cut_);
  }

  /// Computes the weighted sums of the terms (N) for normalised states (DxN). Throws by
  /// refuse_cost() if a term returns NaN.
  virtual void evaluate(const Eigen::MatrixXd& states, Eigen::Ref<Eigen::VectorXd> costs) = 0;

  /// Returns true if the terms are a sum of squares and this backend computes their residuals.
  virtual bool has_residuals() const { return false; }
  /// Returns the number of residuals per hypothesis of the prepared frame.
  virtual Eigen::Index residual_count() const { return 0; }
  /// See Evaluator::pose_only_residuals().
  virtual std::vector<ResidualRows> pose_only_residuals() const { return {}; }
  /// Computes costs and residuals (residual_count() x N); requires has_residuals().
  virtual void evaluate_residuals(const Eigen::MatrixXd& states,
                                  Eigen::Ref<Eigen::MatrixXf> residuals,
                                  Eigen::Ref<Eigen::VectorXd> costs);

  /// Returns numerical normal equations for normalised states, without copying residuals out. Null
  /// if evaluate_residuals() is as fast.
  virtual ResidualDifferences* differences() { return nullptr; }

  /// See ResidualCost; takes normalised states.
  virtual bool can_linearize() const { return false; }
  virtual NormalEquations linearize(const Eigen::MatrixXd& states, const Eigen::VectorXd& steps,
                                    double blur);

  /// Returns the text of Evaluator::backend(): `cpu (AVX3, 2 threads)`.
  virtual std::string description() const = 0;

  /// Returns true if device_cost() is available.
  virtual bool on_device() const { return false; }
  /// Returns the costs of search points on the GPU (Evaluator::device_cost), or null on the host.
  virtual cuda::DeviceCost* device_cost(const Eigen::VectorXd&, bool) { return nullptr; }

 private:
  Observation cut_;
};

/// Makes the backend that the settings select; never a silent substitute. The scene must outlive
/// it. Throws DeviceError if it is unavailable, and by check_requirements() if the terms or the
/// backend lack what is required.
std::unique_ptr<Evaluation> make_evaluation(const Scene& scene,
                                            const std::vector<ObjectiveTerm>& terms,
                                            const EvaluateSettings& settings,
                                            const Requirements& requirements);

/// Makes the evaluation that draws with a HypothesisRenderer and scores on the CPU. `why_here` is
/// the reason for not using a GPU; its description() includes it.
std::unique_ptr<Evaluation> make_host_evaluation(const Scene& scene,
                                                 const std::vector<ObjectiveTerm>& terms,
                                                 const EvaluateSettings& settings,
                                                 std::string why_here = {});

/// Returns why `backend: auto` evaluates these terms on the CPU; empty if it uses the GPU.
std::string why_automatic_on_cpu(const Scene& scene, const std::vector<ObjectiveTerm>& terms,
                                 const EvaluateSettings& settings,
                                 const Requirements& requirements);

/// Throws Error that says what a term did wrong for a hypothesis (`returned NaN`).
[[noreturn]] void refuse_cost(const ObjectiveTerm& term, Eigen::Index index, const char* what);

namespace cuda {

/// Returns why the settings' GPU cannot evaluate these terms, with `residuals` if true; empty if it
/// can.
std::string why_not_evaluated(const Scene& scene, const std::vector<ObjectiveTerm>& terms,
                              const EvaluateSettings& settings, bool residuals);

/// Makes the evaluation that poses, draws and scores on the GPU. Throws DeviceError with the reason
/// of why_not_evaluated(), if there is one.
std::unique_ptr<Evaluation> make_evaluation(const Scene& scene,
                                            const std::vector<ObjectiveTerm>& terms,
                                            const EvaluateSettings& settings, bool residuals);

}  // namespace cuda
}  // namespace hypotrack
