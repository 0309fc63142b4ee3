#include "cuda/egl_cuda_evaluation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "cuda/device.hpp"
#include "cuda/device_scene.hpp"
#include "cuda/frame_layout.hpp"
#include "cuda/gl_interop.hpp"
#include "cuda/tile_upload.hpp"
#include "evaluate/egl_drawer.hpp"
#include "hypotrack/error.hpp"
#include "render/egl_context.hpp"

namespace hypotrack::cuda {
namespace {

constexpr std::int64_t kMostBytes = std::int64_t{1} << 30;  // of drawn hypotheses

class EglCudaEvaluation final : public Evaluation {
 public:
  EglCudaEvaluation(const Scene& scene, const std::vector<ObjectiveTerm>& terms,
                    const EvaluateSettings& settings, std::unique_ptr<EglDrawer> drawer)
      : device_(settings.device), scene_(scene), terms_(terms), drawer_(std::move(drawer)) {
    for (const ObjectiveTerm& term : terms_) {
      objectives_.push_back(term.objective->on_device());
    }
    frame_.reserve(1);
    frame_staging_.reserve(1);
  }

  ~EglCudaEvaluation() override { cudaStreamSynchronize(native(stream())); }

  using Evaluation::prepare;
  void prepare(const Observation& observation) override {
    device_.use();
    synchronize("waiting for the frame before");
    drawer_->prepare(observation);
    *frame_staging_.data() = frame_layout(observation);
    copy(frame_.data(), frame_staging_.data(), 1, cudaMemcpyHostToDevice);
    DeviceObservation uploaded = upload_.upload(observation, stream());
    uploaded.header = &observation;
    uploaded.frame = frame_.data();
    uploaded.pair = frame_staging_.data()->pair != 0;
    for (const auto& objective : objectives_) objective->prepare(uploaded, stream());
  }

  void evaluate(const Eigen::MatrixXd& states, Eigen::Ref<Eigen::VectorXd> costs) override {
    if (states.cols() == 0) return;
    device_.use();
    const Eigen::Index batch = std::min(states.cols(), largest_batch());
    reserve(states, batch);
    const auto size = static_cast<std::size_t>(states.size());
    std::copy_n(states.data(), size, points_staging_.data());
    copy(points_.data(), points_staging_.data(), size, cudaMemcpyHostToDevice);
    for (Eigen::Index first = 0; first < states.cols(); first += batch) {
      draw_and_score(states, first, std::min(batch, states.cols() - first));
      synchronize("scoring hypotheses");
    }
    for (Eigen::Index i = 0; i < states.cols(); ++i) {
      costs[i] = costs_staging_.data()[i];
      if (std::isnan(costs[i])) refuse_cost(terms_.front(), i, "(or one after it) returned NaN");
    }
  }

  std::string description() const override {
    return fmt::format("egl ({}, CUDA interop)", drawer_->context().device());
  }

 private:
  Stream stream() const { return device_.stream(); }

  void synchronize(const char* doing) const {
    check(cudaStreamSynchronize(native(stream())), doing);
  }

  template <class T>
  void copy(T* to, const T* from, std::size_t count, cudaMemcpyKind kind) const {
    check(cudaMemcpyAsync(to, from, count * sizeof(T), kind, native(stream())), "copying");
  }

  Eigen::Index largest_batch() const {
    const LayerSize one = drawer_->layers_for(1);
    const std::int64_t bytes = std::int64_t{4} * one.width * one.height * one.layers;
    return std::clamp<Eigen::Index>(kMostBytes / std::max<std::int64_t>(bytes, 1), 1,
                                    drawer_->largest_batch());
  }

  void reserve(const Eigen::MatrixXd& states, Eigen::Index batch) {
    points_.reserve(static_cast<std::size_t>(states.size()));
    points_staging_.reserve(static_cast<std::size_t>(states.size()));
    costs_.reserve(static_cast<std::size_t>(states.cols()));
    costs_staging_.reserve(static_cast<std::size_t>(states.cols()));
    for (std::size_t i = 0; i < terms_.size(); ++i) {
      if (terms_[i].weight == 0) continue;
      objectives_[i]->reserve(scene_.layout(), device_.limits(), batch);
    }
    const LayerSize size = drawer_->layers_for(batch);
    if (layers_ && layers_->layers().holds(size)) return;
    layers_.reset();
    layers_ = std::make_unique<SharedLayers>(drawer_->context(), size);
  }

  void draw_and_score(const Eigen::MatrixXd& states, Eigen::Index first, Eigen::Index count) {
    const gl::CurrentContext current(drawer_->context());
    drawer_->draw(states.middleCols(first, count), layers_->layers());
    const MappedLayers drawn(*layers_, stream());
    enqueue(states.cols(), {drawn.texture(), static_cast<int>(first), static_cast<int>(count)});
    copy(costs_staging_.data() + first, costs_.data() + first, static_cast<std::size_t>(count),
         cudaMemcpyDeviceToHost);
  }

  void enqueue(Eigen::Index all, const DrawnBatch& drawn) {
    BatchLayout batch{points_.data(), all, costs_.data(), 0, nullptr, false};
    for (std::size_t i = 0; i < terms_.size(); ++i) {
      if (terms_[i].weight == 0) continue;
      batch.weight = terms_[i].weight;
      objectives_[i]->enqueue_drawn(scene_.layout(), batch, drawn, stream());
      batch.add = true;
    }
  }

  Device device_;
  DeviceScene scene_;
  std::vector<ObjectiveTerm> terms_;
  std::vector<std::unique_ptr<DeviceObjective>> objectives_;  // of the terms
  std::unique_ptr<EglDrawer> drawer_;
  std::unique_ptr<const SharedLayers> layers_;  // of the drawer's context
  TileUpload upload_;
  DeviceBuffer<FrameLayout> frame_;
  PinnedBuffer<FrameLayout> frame_staging_;
  DeviceBuffer<double> points_, costs_;
  PinnedBuffer<double> points_staging_, costs_staging_;
};

bool looks_at_pictures(const ObjectiveTerm& term) {
  return term.weight != 0 && term.objective->needs_rendering();
}

}  // namespace

std::unique_ptr<Evaluation> make_egl_evaluation(const Scene& scene,
                                                const std::vector<ObjectiveTerm>& terms,
                                                const EvaluateSettings& settings,
                                                std::string& why_not) {
  why_not = why_not_evaluated(scene, terms, settings);
  if (std::none_of(terms.begin(), terms.end(), looks_at_pictures)) {
    why_not = "no objective looks at pictures";
  }
  if (!why_not.empty()) return nullptr;
  auto drawer = std::make_unique<EglDrawer>(scene);
  why_not = why_not_shared(drawer->context(), settings.device);
  if (!why_not.empty()) return nullptr;
  return std::make_unique<EglCudaEvaluation>(scene, terms, settings, std::move(drawer));
}

}  // namespace hypotrack::cuda
