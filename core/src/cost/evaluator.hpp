#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "hypotrack/export.hpp"
#include "hypotrack/objective.hpp"
#include "hypotrack/optimizer.hpp"
#include "hypotrack/params.hpp"
#include "hypotrack/scene.hpp"
#include "tile/tiles.hpp"

namespace hypotrack {

enum class Backend { automatic, cpu, egl, cuda };
HYPOTRACK_API std::span<const std::string_view> enum_names(Backend);

/// Parameters of a scene's `evaluate:` section.
struct EvaluateSettings {
  Backend backend = Backend::automatic;
  int threads = 0;
  int device = 0;
  void visit(ParamVisitor& v) {
    v("backend", backend,
      {.help =
           "what draws hypotheses: cpu; cuda (an NVIDIA GPU: poses, draws and scores there); egl "
           "(OpenGL, the paper's way; slow, a cross-check); or auto: cuda where this build, "
           "machine and scene allow it, otherwise cpu"});
    v("threads", threads, {.help = "CPU threads; 0: one per core", .min = 0, .max = 1024});
    v("device", device,
      {.help = "number of the NVIDIA GPU, where there are several", .min = 0, .max = 1024});
  }
};

/// A weighted term of the cost.
struct ObjectiveTerm {
  double weight = 1;  ///< 0 = the term is prepared but not evaluated
  std::shared_ptr<Objective> objective;
  std::string name = {};  ///< for messages
};

/// A range of consecutive residuals.
struct ResidualRows {
  Eigen::Index first = 0, count = 0;
};

/// Turns batches of hypotheses into costs: normalises, poses, skins, draws depth tiles of both
/// views, and scores. It uses several threads; the result does not depend on their number.
class HYPOTRACK_API Evaluator {
 public:
  /// The scene must outlive the evaluator. Throws DeviceError if the backend is unavailable, and by
  /// check_requirements() if the terms or the backend lack what is required.
  Evaluator(const Scene& scene, std::vector<ObjectiveTerm> terms, const EvaluateSettings& settings,
            const Requirements& requirements = {});
  ~Evaluator();
  Evaluator(const Evaluator&) = delete;
  Evaluator& operator=(const Evaluator&) = delete;

  /// Prepares the evaluator and the terms for a frame. The observation must outlive the
  /// evaluations.
  void prepare(const Observation& observation);
  /// Prepares for drawing only. Precondition: every term was already prepared with this
  /// observation.
  void prepare_drawing(const Observation& observation);
  /// Prepares a frame from the images that its terms read; the backend resamples the tiles, on the
  /// GPU if it can. The frame's images must outlive the evaluations.
  void prepare(const TileMaker& tiles, const Frame& frame, TilePlan plan);

  /// Computes the weighted sums of the terms (N) for states (DxN, one per column). Throws Error,
  /// naming the term, if one returns NaN; exceptions of terms pass through unchanged.
  /// A model with a parameter that is not finite or exceeds 1e6 is not drawn. Nor are triangles
  /// with a corner nearer than 1 cm, farther than 1 km or a million pixels off. A closed model
  /// wound outwards is drawn without back faces.
  void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& states, Eigen::Ref<Eigen::VectorXd> costs);

  /// Returns true if residuals are available; always true if they were required.
  bool has_residuals() const;
  /// Returns the number M of residuals per state, for the prepared frame.
  Eigen::Index residual_count() const;
  /// Returns the residuals of terms that read no images, if other terms do.
  std::vector<ResidualRows> pose_only_residuals() const;
  /// Computes the costs (N) and the residuals (MxN) of states; the squares of a column add up to
  /// its cost as ResidualTerm defines.
  void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& states,
                Eigen::Ref<Eigen::MatrixXf> residuals, Eigen::Ref<Eigen::VectorXd> costs);

  /// Returns numerical normal equations with residuals in GPU memory; null on other backends. The
  /// evaluator owns the result.
  ResidualDifferences* differences();

  /// Returns true if linearize() is available: every term needs no rendering, or its residuals
  /// belong to pixels and have slopes.
  bool can_linearize() const;
  /// Computes the normal equations at states.col(0), with columns per step
  /// (ResidualCost::linearize).
  NormalEquations linearize(const Eigen::Ref<const Eigen::MatrixXd>& states,
                            const Eigen::Ref<const Eigen::VectorXd>& steps, double blur);

  /// Returns true if device_cost() is available.
  bool on_device() const;
  /// Returns the costs of search points in GPU memory, for the prepared frame; null on other
  /// backends. Points are states. With `rotation_vectors`, a rotation vector (3 numbers) replaces
  /// every model's quaternion and applies to that of `prior` (SearchSpace).
  cuda::DeviceCost* device_cost(const Eigen::VectorXd& prior, bool rotation_vectors);

  /// Describes the backend: `cpu (AVX3, 2 threads)`, `egl (llvmpipe ...)`.
  std::string backend() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hypotrack
