#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "cost/cuda/device_residuals.hpp"
#include "cost/cuda/device_scene.hpp"
#include "cost/cuda/frame_on_device.hpp"
#include "cost/cuda/host_batch.hpp"
#include "cost/cuda/tile_cutter.hpp"
#include "cost/cuda/transfer.hpp"
#include "cost/evaluation.hpp"
#include "cost/term_residuals.hpp"
#include "hypotrack/cuda/device_cost.hpp"
#include "hypotrack/error.hpp"

namespace hypotrack::cuda {
namespace {

/// Everything on the GPU: hypotheses go up (or are there already), costs come down.
class CudaEvaluation final : public Evaluation, public DeviceCost {
 public:
  CudaEvaluation(const Scene& scene, const std::vector<ObjectiveTerm>& terms,
                 const EvaluateSettings& settings)
      : frame_(scene, terms, settings),
        sum_of_squares_(TermResiduals::why_none(terms).empty()),
        residuals_(frame_, batch_),
        prior_(static_cast<std::size_t>(scene.dimension())),
        prior_staging_(prior_.size()) {}
  ~CudaEvaluation() override { cudaStreamSynchronize(native(stream())); }

  void prepare(const Observation& observation) override {
    frame_.finish();
    frame_.prepare(observation);
  }
  void prepare(const TileMaker& tiles, const Frame& frame, const TilePlan& plan) override {
    frame_.finish();
    const bool host_only =
        std::ranges::any_of(plan.cuts, [](const CutPlan& cut) { return !cut.brightness.empty(); });
    if (host_only) return Evaluation::prepare(tiles, frame, plan);
    if (!cutter_) {
      cutter_ = std::make_unique<TileCutter>(tiles.resamplers(), frame_.device().limits());
    }
    const auto work = [&] {
      return work_of(tiles.posed(plan.header.start), plan.header.views[0].camera);
    };
    if (!work_) work_ = work();
    frame_.prepare(cutter_->cut(frame, plan, stream(), *work_));
    work_ = work();  // for the next frame, in which it is much the same, while the GPU has to do
  }

  void evaluate(const Eigen::MatrixXd& states, Eigen::Ref<Eigen::VectorXd> costs) override {
    if (states.cols() == 0) return;
    frame_.device().use();
    use_prior(nullptr);
    reserve(states.cols());
    batch_.upload(states, stream());
    frame_.enqueue(batch_.layout());
    batch_.download(0, states.cols(), stream());
    check(cudaStreamSynchronize(native(stream())), "evaluating hypotheses");
    batch_.read(costs, frame_.terms());
  }

  bool has_residuals() const override { return sum_of_squares_ && frame_.has_residuals(); }
  Eigen::Index residual_count() const override { return frame_.residual_count(); }
  std::vector<ResidualRows> pose_only_residuals() const override {
    return frame_.pose_only_residuals();
  }
  void evaluate_residuals(const Eigen::MatrixXd& states, Eigen::Ref<Eigen::MatrixXf> residuals,
                          Eigen::Ref<Eigen::VectorXd> costs) override {
    residuals_.download(states, residuals, costs);
  }
  ResidualDifferences* differences() override { return has_residuals() ? &residuals_ : nullptr; }

  std::string description() const override {
    return fmt::format("cuda ({})", frame_.device().name());
  }

  bool on_device() const override { return true; }
  DeviceCost* device_cost(const Eigen::VectorXd& prior, bool rotation_vectors) override {
    frame_.device().use();
    use_prior(rotation_vectors ? &prior : nullptr);
    return this;
  }

  // DeviceCost
  Stream stream() const override { return frame_.stream(); }
  void reserve(std::int64_t count) override { frame_.reserve(count); }
  void enqueue(const double* points, std::int64_t count, double* costs) override {
    frame_.enqueue({points, count, costs, 0, rotation_vectors_ ? prior_.data() : nullptr, false});
  }
  bool enqueue_search(const SwarmSearch& search) override {
    return frame_.enqueue_search(
        {nullptr, search.particles, nullptr, 0, rotation_vectors_ ? prior_.data() : nullptr, false},
        search);
  }
  std::uint64_t revision() const override { return revision_ + frame_.revision(); }

 private:
  void use_prior(const Eigen::VectorXd* prior) {
    if (rotation_vectors_ != (prior != nullptr)) ++revision_;
    rotation_vectors_ = prior != nullptr;
    if (!prior) return;
    std::copy_n(prior->data(), prior_.size(), prior_staging_.data());
    to_device(prior_, prior_staging_, prior_.size(), stream());
  }

  FrameOnDevice frame_;
  std::unique_ptr<TileCutter> cutter_;  // of the first frame's cameras; there are no others
  std::optional<WorkEnds> work_;
  HostBatch batch_;
  bool sum_of_squares_;
  DeviceResiduals residuals_;
  DeviceBuffer<double> prior_;
  PinnedBuffer<double> prior_staging_;
  bool rotation_vectors_ = false;
  std::uint64_t revision_ = 0;  // only grows, as those of the terms do
};

}  // namespace

std::string why_not_evaluated(const Scene& scene, const std::vector<ObjectiveTerm>& terms,
                              const EvaluateSettings& settings, bool residuals) {
  if (std::string why = why_no_device(settings.device); !why.empty()) return why;
  if (std::string why = why_not_on_device(scene); !why.empty()) return why;
  for (const ObjectiveTerm& term : terms) {
    const auto on_device = term.objective->on_device();
    if (!on_device) return fmt::format("objective {} has no device capability", term.name);
    if (residuals && term.weight != 0 && !on_device->has_residuals()) {
      return fmt::format("the optimizer needs residuals, and objective {} has them on the CPU only",
                         term.name);
    }
  }
  return why_not_this_device(settings.device);
}

std::unique_ptr<Evaluation> make_evaluation(const Scene& scene,
                                            const std::vector<ObjectiveTerm>& terms,
                                            const EvaluateSettings& settings, bool residuals) {
  const std::string why = why_not_evaluated(scene, terms, settings, residuals);
  if (!why.empty()) {
    throw DeviceError("evaluate.backend: cuda: " + why +
                      ". Write `backend: cpu`, or `auto` to take what there is");
  }
  return std::make_unique<CudaEvaluation>(scene, terms, settings);
}

}  // namespace hypotrack::cuda
