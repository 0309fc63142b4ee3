#include <fmt/format.h>

#include <cmath>

#include "cuda/device.hpp"
#include "cuda/device_scene.hpp"
#include "cuda/frame_layout.hpp"
#include "cuda/tile_cutter.hpp"
#include "cuda/tile_upload.hpp"
#include "evaluate/evaluation.hpp"
#include "hypotrack/cuda/device_cost.hpp"

namespace hypotrack::cuda {
namespace {

/// Everything on the GPU: hypotheses go up (or are there already), costs come down.
class CudaEvaluation final : public Evaluation, public DeviceCost {
 public:
  CudaEvaluation(const Scene& scene, const std::vector<ObjectiveTerm>& terms,
                 const EvaluateSettings& settings)
      : device_(settings.device), scene_(scene), terms_(terms), frame_(1), frame_staging_(1) {
    for (const ObjectiveTerm& term : terms_) {
      objectives_.push_back(term.objective->on_device());
    }
    prior_.reserve(static_cast<std::size_t>(scene.dimension()));
    prior_staging_.reserve(prior_.size());
  }
  ~CudaEvaluation() override { cudaStreamSynchronize(native(stream())); }

  void prepare(const Observation& observation) override {
    finish_frame_before();
    observation_ = upload_.upload(observation, stream());
    prepare_frame(observation);
  }
  void prepare(const TileMaker& tiles, const Frame& frame, const TilePlan& plan) override {
    finish_frame_before();
    if (!cutter_) {
      cutter_ = std::make_unique<TileCutter>(tiles.resamplers(), device_.limits());
    }
    observation_ = cutter_->cut(frame, plan, stream());
    prepare_frame(plan.header);
  }

  void evaluate(const Eigen::MatrixXd& states, Eigen::Ref<Eigen::VectorXd> costs) override {
    if (states.cols() == 0) return;
    device_.use();
    use_prior(nullptr);
    const auto count = static_cast<std::size_t>(states.cols());
    const auto size = static_cast<std::size_t>(states.size());
    reserve(states.cols());
    points_.reserve(size);
    points_staging_.reserve(size);
    costs_.reserve(count);
    costs_staging_.reserve(count);
    std::copy_n(states.data(), size, points_staging_.data());
    copy(points_.data(), points_staging_.data(), size, cudaMemcpyHostToDevice);
    enqueue(points_.data(), states.cols(), costs_.data());
    copy(costs_staging_.data(), costs_.data(), count, cudaMemcpyDeviceToHost);
    check(cudaStreamSynchronize(native(stream())), "evaluating hypotheses");
    for (Eigen::Index i = 0; i < states.cols(); ++i) {
      costs[i] = costs_staging_.data()[i];
      if (std::isnan(costs[i])) refuse_cost(terms_.front(), i, "(or one after it) returned NaN");
    }
  }

  std::string description() const override { return fmt::format("cuda ({})", device_.name()); }

  DeviceCost* device_cost(const Eigen::VectorXd& prior, bool rotation_vectors) override {
    device_.use();
    use_prior(rotation_vectors ? &prior : nullptr);
    return this;
  }

  // DeviceCost
  Stream stream() const override { return device_.stream(); }
  void reserve(std::int64_t count) override {
    for (std::size_t i = 0; i < terms_.size(); ++i) {
      if (terms_[i].weight == 0) continue;
      objectives_[i]->reserve(scene_.layout(), device_.limits(), count);
    }
  }
  void enqueue(const double* points, std::int64_t count, double* costs) override {
    BatchLayout batch{points, count, costs, 0, rotation_vectors_ ? prior_.data() : nullptr, false};
    for (std::size_t i = 0; i < terms_.size(); ++i) {
      if (terms_[i].weight == 0) continue;
      batch.weight = terms_[i].weight;
      objectives_[i]->enqueue(scene_.layout(), batch, stream());
      batch.add = true;
    }
    if (batch.add) return;
    const auto bytes = static_cast<std::size_t>(count) * sizeof(double);
    check(cudaMemsetAsync(costs, 0, bytes, native(stream())), "clearing costs");
  }
  std::uint64_t revision() const override {
    std::uint64_t sum = revision_;  // of numbers that only grow: changes if any of them does
    for (const auto& objective : objectives_) sum += objective->revision();
    return sum;
  }

 private:
  template <class T>
  void copy(T* to, const T* from, std::size_t count, cudaMemcpyKind kind) {
    check(cudaMemcpyAsync(to, from, count * sizeof(T), kind, native(stream())), "copying");
  }

  /// Its uploads may still read the staging memory: it was never searched, or an error ended that.
  void finish_frame_before() {
    device_.use();
    check(cudaStreamSynchronize(native(stream())), "finishing the frame before");
  }

  void prepare_frame(const Observation& header) {
    *frame_staging_.data() = frame_layout(header);
    copy(frame_.data(), frame_staging_.data(), 1, cudaMemcpyHostToDevice);
    observation_.header = &header;
    observation_.frame = frame_.data();
    observation_.pair = frame_staging_.data()->pair != 0;
    for (const auto& objective : objectives_) objective->prepare(observation_, stream());
  }

  void use_prior(const Eigen::VectorXd* prior) {
    if (rotation_vectors_ != (prior != nullptr)) ++revision_;
    rotation_vectors_ = prior != nullptr;
    if (!prior) return;
    std::copy_n(prior->data(), prior_.size(), prior_staging_.data());
    copy(prior_.data(), prior_staging_.data(), prior_.size(), cudaMemcpyHostToDevice);
  }

  Device device_;
  DeviceScene scene_;
  std::vector<ObjectiveTerm> terms_;
  std::vector<std::unique_ptr<DeviceObjective>> objectives_;  // of the terms
  TileUpload upload_;
  std::unique_ptr<TileCutter> cutter_;  // of the first frame's cameras; there are no others
  DeviceObservation observation_;
  DeviceBuffer<FrameLayout> frame_;
  PinnedBuffer<FrameLayout> frame_staging_;
  DeviceBuffer<double> points_, costs_, prior_;
  PinnedBuffer<double> points_staging_, costs_staging_, prior_staging_;
  bool rotation_vectors_ = false;
  std::uint64_t revision_ = 0;
};

}  // namespace

std::string why_not_evaluated(const Scene& scene, const std::vector<ObjectiveTerm>& terms,
                              const EvaluateSettings& settings) {
  if (std::string why = why_no_device(settings.device); !why.empty()) return why;
  if (std::string why = why_not_on_device(scene); !why.empty()) return why;
  for (const ObjectiveTerm& term : terms) {
    if (term.objective->on_device()) continue;
    return fmt::format("objective {} has no device capability", term.name);
  }
  return why_not_this_device(settings.device);
}

std::unique_ptr<Evaluation> make_evaluation(const Scene& scene,
                                            const std::vector<ObjectiveTerm>& terms,
                                            const EvaluateSettings& settings) {
  if (const std::string why = why_not_evaluated(scene, terms, settings); !why.empty()) {
    throw DeviceError("evaluate.backend: cuda: " + why +
                      ". Write `backend: cpu`, or `automatic` to take what there is");
  }
  return std::make_unique<CudaEvaluation>(scene, terms, settings);
}

}  // namespace hypotrack::cuda
