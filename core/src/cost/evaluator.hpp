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

/// `evaluate:` of a scene.
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

/// One term of the cost.
struct ObjectiveTerm {
  double weight = 1;  ///< 0: the term is prepared but not asked
  std::shared_ptr<Objective> objective;
  std::string name = {};  ///< for messages
};

/// What is wanted of residuals.
struct ResidualUse {
  bool wanted = false;
  Linearization linearization = Linearization::unused;  ///< where they are
};

/// Residuals that follow each other.
struct ResidualRows {
  Eigen::Index first = 0, count = 0;
};

/// Turns hypotheses into costs: normalise, pose, skin, draw both views' depth tiles, score. Whole
/// batches at a time, over threads; the result does not depend on the number of threads.
class HYPOTRACK_API Evaluator {
 public:
  /// The scene must outlive the evaluator. Throws DeviceError if the backend is not to be had, and
  /// ConfigError if a term or the backend does not have what is wanted of residuals.
  Evaluator(const Scene& scene, std::vector<ObjectiveTerm> terms, const EvaluateSettings& settings,
            const ResidualUse& use = {});
  ~Evaluator();
  Evaluator(const Evaluator&) = delete;
  Evaluator& operator=(const Evaluator&) = delete;

  /// Takes a frame in, for the terms as well; the observation must outlive the evaluations.
  void prepare(const Observation& observation);
  /// The same after another evaluator of the same terms has taken that observation in, and nobody
  /// another one since: on the CPU the terms are as they should be.
  void prepare_drawing(const Observation& observation);
  /// The same for a frame whose tiles are not cut yet, of images that a term looks at: on the GPU
  /// they are cut there. The frame's images must outlive the evaluations.
  void prepare(const TileMaker& tiles, const Frame& frame, TilePlan plan);

  /// Weighted sums of the terms (N) for states (DxN, one per column). Throws Error, naming the
  /// term, if one returns NaN; what a term throws arrives unchanged. A model with a parameter that
  /// is not finite or over 1e6 is not drawn, nor are triangles with a corner nearer than 1 cm,
  /// farther than 1 km or a million pixels off. A model whose mesh is closed and wound outwards is
  /// drawn without the faces turned away from the camera.
  void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& states, Eigen::Ref<Eigen::VectorXd> costs);

  /// Whether residuals can be had; always if they were announced.
  bool has_residuals() const;
  /// Number M of residuals of every state, for the prepared frame.
  Eigen::Index residual_count() const;
  /// Those of them that belong to terms that look at no picture, where others do.
  std::vector<ResidualRows> pose_only_residuals() const;
  /// The same costs (N), and residuals (MxN) whose squares add up to them (ResidualTerm).
  void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& states,
                Eigen::Ref<Eigen::MatrixXf> residuals, Eigen::Ref<Eigen::VectorXd> costs);

  /// Residuals of states that stay in GPU memory; null on other backends. Outlived by this.
  ResidualDifferences* differences();

  /// Whether linearize() is there: each term's residuals belong to pixels and have slopes, or the
  /// term needs no rendering.
  bool can_linearize() const;
  /// Normal equations at states.col(0), with columns per step (ResidualCost::linearize).
  NormalEquations linearize(const Eigen::Ref<const Eigen::MatrixXd>& states,
                            const Eigen::Ref<const Eigen::VectorXd>& steps, double blur);

  /// Whether device_cost() is there.
  bool on_device() const;
  /// Costs of search points that stay on the GPU, for the prepared frame; null on other backends.
  /// Points are states or, with `rotation_vectors`, states in which every model's quaternion is
  /// replaced by a rotation vector (3 numbers) applied to that of `prior` (SearchSpace).
  cuda::DeviceCost* device_cost(const Eigen::VectorXd& prior, bool rotation_vectors);

  /// What draws: `cpu (AVX3, 2 threads)`, `egl (llvmpipe ...)`.
  std::string backend() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hypotrack
