#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "cost/backends.hpp"
#include "cost/cuda/draw/gl_interop.hpp"
#include "cost/cuda/frame_on_device.hpp"
#include "cost/cuda/host_batch.hpp"
#include "cost/cuda/memory/transfer.hpp"
#include "cost/gl/egl_drawer.hpp"
#include "gl/egl_context.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack::cuda::internal {
namespace {

constexpr std::int64_t kMostBytes = std::int64_t{1} << 30;  // of drawn hypotheses

/// Draws with OpenGL, scores with CUDA.
class EglCudaCost final : public Cost {
 public:
  EglCudaCost(const Scene& scene, const std::vector<ObjectiveTerm>& terms,
              const EvaluateSettings& settings, std::unique_ptr<EglDrawer> drawer)
      : Cost(scene, terms), frame_(scene, terms, settings), drawer_(std::move(drawer)) {}
  ~EglCudaCost() override { cudaStreamSynchronize(native(frame_.stream())); }

  std::string backend() const override {
    return fmt::format("egl ({}, CUDA interop)", drawer_->context().device());
  }

 protected:
  void prepare_observation(const Observation& observation) override {
    frame_.finish();
    drawer_->prepare(observation);
    frame_.prepare(observation);
  }

  void evaluate_normalized(const Eigen::MatrixXd& states,
                           Eigen::Ref<Eigen::VectorXd> costs) override {
    if (states.cols() == 0) return;
    frame_.device().use();
    const Eigen::Index layers = std::min(states.cols(), largest_batch());
    reserve(layers);
    batch_.upload(states, frame_.stream());
    for (Eigen::Index first = 0; first < states.cols(); first += layers) {
      draw_and_score(states, first, std::min(layers, states.cols() - first));
      wait_for(frame_.stream(), "scoring hypotheses");
    }
    batch_.read(costs, frame_.terms());
  }

 private:
  Eigen::Index largest_batch() const {
    const LayerSize one = drawer_->layers_for(1);
    const std::int64_t bytes = std::int64_t{4} * one.width * one.height * one.layers;
    return std::clamp<Eigen::Index>(kMostBytes / std::max<std::int64_t>(bytes, 1), 1,
                                    drawer_->largest_batch());
  }

  void reserve(Eigen::Index hypotheses) {
    frame_.reserve(hypotheses);
    const LayerSize size = drawer_->layers_for(hypotheses);
    if (layers_ && layers_->layers().holds(size)) return;
    layers_.reset();
    layers_ = std::make_unique<SharedLayers>(drawer_->context(), size);
  }

  void draw_and_score(const Eigen::MatrixXd& states, Eigen::Index first, Eigen::Index count) {
    const gl::CurrentContext current(drawer_->context());
    drawer_->draw(states.middleCols(first, count), layers_->layers());
    const MappedLayers drawn(*layers_, frame_.stream());
    frame_.enqueue_drawn(batch_.layout(),
                         {drawn.texture(), static_cast<int>(first), static_cast<int>(count)});
    batch_.download(first, count, frame_.stream());
  }

  FrameOnDevice frame_;
  HostBatch batch_;
  std::unique_ptr<EglDrawer> drawer_;
  std::unique_ptr<const SharedLayers> layers_;  // of the drawer's context
};

bool looks_at_pictures(const ObjectiveTerm& term) {
  return term.weight != 0 && term.objective->needs_rendering();
}

}  // namespace

std::unique_ptr<Cost> make_egl_cost(const Scene& scene, const std::vector<ObjectiveTerm>& terms,
                                    const EvaluateSettings& settings, std::string& why_not) {
  why_not = why_not_evaluated(scene, terms, settings, false);
  if (std::none_of(terms.begin(), terms.end(), looks_at_pictures)) {
    why_not = "no objective looks at pictures";
  }
  if (!why_not.empty()) return nullptr;
  auto drawer = std::make_unique<EglDrawer>(scene);
  why_not = why_not_shared(drawer->context(), settings.device);
  if (!why_not.empty()) return nullptr;
  return std::make_unique<EglCudaCost>(scene, terms, settings, std::move(drawer));
}

}  // namespace hypotrack::cuda::internal
