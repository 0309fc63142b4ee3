#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/objective.hpp"
#include "hypotrack/plugin/optimizer.hpp"
#include "hypotrack/plugin/params.hpp"
#include "tile/tiles.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

enum class Backend { automatic, cpu, egl, cuda };
std::span<const std::string_view> enum_names(Backend);

/// What happens after a GPU failed in the middle of a run.
enum class OnDeviceLoss { stop, cpu };
std::span<const std::string_view> enum_names(OnDeviceLoss);

/// Parameters of a scene's `evaluate:` section.
struct EvaluateSettings {
  Backend backend = Backend::automatic;
  int threads = 0;
  int device = 0;
  OnDeviceLoss on_device_loss = OnDeviceLoss::stop;
  void visit(ParamVisitor& v) {
    v("backend", backend,
      {.help =
           "what draws hypotheses: cpu; cuda (an NVIDIA GPU: poses, draws and scores there); egl "
           "(OpenGL, the paper's way; slow, a cross-check); or auto: cuda where this build, "
           "machine and scene allow it, otherwise cpu"});
    v("threads", threads, {.help = "CPU threads; 0: one per core", .min = 0, .max = 1024});
    v("device", device,
      {.help = "number of the NVIDIA GPU, where there are several", .min = 0, .max = 1024});
    v("on_device_loss", on_device_loss,
      {.help =
           "reaction of a run to a failing GPU: stop, and keep the frames so far; or cpu: note it, "
           "and search this frame and all later ones on the CPU"});
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

/// Residuals of states: ResidualCost with states (DxN) in place of search points. They need not be
/// normalised.
class StateResiduals : public ResidualCost {
 public:
  /// Returns the residuals of terms that read no images, if other terms do.
  virtual std::vector<ResidualRows> pose_only() const = 0;
};

/// Returns the images that any of the terms reads.
ImageUse joined_use(const std::vector<ObjectiveTerm>& terms);

/// Turns batches of states into costs: normalises, poses, skins, draws depth tiles of every view,
/// and scores. Each backend is one implementation (make_cost()). It uses several threads; the
/// result does not depend on their number. Every function that draws calls check_stop(), on the CPU
/// for every hypothesis.
class Cost {
 public:
  virtual ~Cost();
  Cost(const Cost&) = delete;
  Cost& operator=(const Cost&) = delete;

  /// Prepares the backend and the terms for a frame. The observation must outlive the evaluations.
  void prepare(const Observation& observation);
  /// Prepares for drawing only. Precondition: every term was already prepared with this
  /// observation.
  void prepare_drawing(const Observation& observation);
  /// Prepares a frame from the images that the terms read; the backend resamples the tiles, on the
  /// GPU if it can. The frame's images must outlive the evaluations.
  void prepare(const TileMaker& tiles, const Frame& frame, TilePlan plan);

  /// Computes the weighted sums of the terms (N) for states (DxN, one per column). Throws Error,
  /// naming the term, if one returns NaN; exceptions of terms pass through unchanged.
  /// A model with a parameter that is not finite or exceeds 1e6 is not drawn. Nor are triangles
  /// with a corner nearer than 1 cm, farther than 1 km or a million pixels off. A closed model
  /// wound outwards is drawn without back faces.
  void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& states, Eigen::Ref<Eigen::VectorXd> costs);

  /// Returns the residuals, or null if a term has none on this backend. Never null if they were
  /// required. This cost owns the result.
  virtual StateResiduals* least_squares() { return nullptr; }

  /// Returns the costs of points in GPU memory, for the prepared frame; null on other backends.
  /// Points are states. With `rotations_from`, a state, a rotation vector (3 numbers) replaces
  /// every model's quaternion and applies to that of `rotations_from`. This cost owns the result.
  virtual cuda::DeviceCost* device(const Eigen::VectorXd* rotations_from = nullptr);

  /// Returns true if CUDA draws and scores, so that searches leave most cores idle.
  virtual bool is_on_gpu() const { return false; }

  /// Describes the backend: `cpu (AVX3, 2 threads)`, `egl (llvmpipe ...)`.
  virtual std::string backend() const = 0;

  /// Returns the normalised states of a batch, valid until the next call. Throws Error if no frame
  /// is prepared or the sizes do not fit; `costs` is the number of costs that there is room for.
  const Eigen::MatrixXd& normalized(const Eigen::Ref<const Eigen::MatrixXd>& states,
                                    Eigen::Index costs);

 protected:
  /// The scene must outlive the cost. Terms have objectives, names and finite weights.
  Cost(const Scene& scene, std::vector<ObjectiveTerm> terms);

  const std::vector<ObjectiveTerm>& terms() const { return terms_; }
  /// Throws Error if no frame is prepared.
  void check_prepared() const;

  // The three forms of prepare(). By default drawing is prepared together with the terms, and the
  // tiles of images are resampled on the CPU.
  virtual void prepare_observation(const Observation& observation) = 0;
  virtual void prepare_only_drawing(const Observation& observation);
  /// Frame and plan outlive every use until the next call.
  virtual void prepare_images(const TileMaker& tiles, const Frame& frame, const TilePlan& plan);
  virtual void evaluate_normalized(const Eigen::MatrixXd& states,
                                   Eigen::Ref<Eigen::VectorXd> costs) = 0;

 private:
  const Scene& scene_;
  std::vector<ObjectiveTerm> terms_;
  // The prepared frame without images that no term reads, its plan and its tiles, if this cost
  // resampled them.
  Frame frame_;
  TilePlan plan_;
  Observation observation_;
  Eigen::MatrixXd normalized_;
  bool prepared_ = false;
};

/// Makes the cost of a scene on the backend that the settings select; never a silent substitute.
/// The scene must outlive it. Throws DeviceError if the backend is unavailable, and by
/// check_requirements() if the terms or the backend lack what is required.
std::unique_ptr<Cost> make_cost(const Scene& scene, std::vector<ObjectiveTerm> terms,
                                const EvaluateSettings& settings,
                                const Requirements& requirements = {});

/// Returns true if make_cost() evaluates these terms with CUDA.
bool evaluates_with_cuda(const Scene& scene, const std::vector<ObjectiveTerm>& terms,
                         const EvaluateSettings& settings, const Requirements& requirements);

}  // namespace internal
}  // namespace hypotrack
