#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "base/profile.hpp"
#include "cost/backends.hpp"
#include "cost/cuda/backend_text.hpp"
#include "cost/cuda/descend/device_descent.hpp"
#include "cost/cuda/draw/device_scene.hpp"
#include "cost/cuda/frame_on_device.hpp"
#include "cost/cuda/host_batch.hpp"
#include "cost/cuda/linearize/device_linearizer.hpp"
#include "cost/cuda/linearize/device_residuals.hpp"
#include "cost/cuda/memory/transfer.hpp"
#include "cost/cuda/repeated_work.hpp"
#include "cost/cuda/tiles/tile_resampler.hpp"
#include "cost/term_residuals.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/gpu/device_cost.hpp"

namespace hypotrack::cuda::internal {
namespace {

/// Poses, draws and scores on the GPU: uploads hypotheses unless they are there already, downloads
/// costs.
class CudaCost final : public Cost, public StateResiduals, public DeviceCost, public DescentCost {
 public:
  CudaCost(const Scene& scene, std::vector<ObjectiveTerm> all, const EvaluateSettings& settings)
      : Cost(scene, std::move(all)),
        frame_(scene, terms(), settings),
        sum_of_squares_(TermResiduals::why_none(terms()).empty()),
        prior_(static_cast<std::size_t>(scene.dimension())),
        prior_staging_(prior_.size()) {}
  ~CudaCost() override { cudaStreamSynchronize(native(stream())); }

  StateResiduals* least_squares() override {
    return sum_of_squares_ && frame_.has_residuals() ? this : nullptr;
  }
  DeviceCost* device(const Eigen::VectorXd* rotations_from) override {
    check_prepared();
    frame_.device().use();
    use_prior(rotations_from);
    return this;
  }
  bool is_on_gpu() const override { return true; }
  std::string backend() const override {
    return backend_text(frame_.device().name(), frame_.device().index());
  }

  // StateResiduals
  Eigen::Index count() const override {
    check_prepared();
    return frame_.residual_count();
  }
  std::vector<ResidualRows> pose_only() const override { return frame_.pose_only_residuals(); }
  void evaluate(const Eigen::Ref<const Eigen::MatrixXd>& states,
                Eigen::Ref<Eigen::MatrixXf> residuals, Eigen::Ref<Eigen::VectorXd> costs) override {
    const Eigen::MatrixXd& batch = normalized(states, costs.size());
    check_room(residuals, count(), batch.cols());
    DeviceResiduals(*this, frame_, batch_, residual_memory_).download(batch, residuals, costs);
  }
  std::unique_ptr<ResidualDifferences> differences() override {
    return std::make_unique<DeviceResiduals>(*this, frame_, batch_, residual_memory_);
  }
  bool can_linearize() const override { return frame_.has_slopes(); }
  bool draws_neighbours() const override { return frame_.draws_differences(); }
  NormalEquations linearize(const Eigen::Ref<const Eigen::MatrixXd>& states,
                            const Eigen::Ref<const Eigen::VectorXd>& steps, double blur) override {
    const Neighbourhood at{states, steps, blur};
    return linearizer_.linearize({&at, 1}).front();
  }
  std::vector<NormalEquations> linearize_each(std::span<const Neighbourhood> points) override {
    return linearizer_.linearize(points);
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
  bool descend(const DampedSettings& settings, std::int32_t dimension, std::span<Descent> searches,
               const std::function<bool()>& ends) override {
    if (!sum_of_squares_ ||
        !descent_.can_run(settings, dimension, searches.size(), rotation_vectors_))
      return false;
    const ProfiledPart part("steps on the GPU");
    descent_.run(settings, dimension, searches, rotation_vectors_ ? prior_.data() : nullptr, ends);
    return true;
  }
  std::uint64_t revision() const override { return revision_ + frame_.revision(); }

 protected:
  void prepare_observation(const Observation& observation) override {
    frame_.finish();
    frame_.prepare(observation);
  }
  void prepare_images(const TileMaker& tiles, const Frame& frame, const TilePlan& plan) override {
    frame_.finish();
    const bool host_only = std::ranges::any_of(plan.views, [](const ResamplePlan& view) {
      return !view.brightness.empty() || !view.hidden.empty();
    });
    if (host_only) return Cost::prepare_images(tiles, frame, plan);
    if (!resampler_) {
      resampler_ = std::make_unique<TileResampler>(tiles.resamplers(), frame_.device().limits());
    }
    const auto bands = [&] {
      // A search for one model plans tiles of that model alone.
      if (plan.header.scene != &tiles.scene()) return even_bands();
      return bands_of_equal_work(tiles.posed(plan.header.start), plan.header.views[0].camera);
    };
    if (!bands_) bands_ = bands();
    frame_.prepare(resampler_->resample(frame, plan, stream(), *bands_));
    bands_ = bands();  // for the next frame, which is similar; runs while the GPU works
  }
  void evaluate_normalized(const Eigen::MatrixXd& states,
                           Eigen::Ref<Eigen::VectorXd> costs) override {
    if (states.cols() == 0) return;
    frame_.device().use();
    use_prior(nullptr);
    if (states.cols() > most_) reserve(states.cols());  // says how many there is room for
    most_ = std::max(most_, states.cols());
    const int sets = frame_.cost_sets(states.cols());
    batch_.take(states, sets);
    const auto arguments = [&] {
      return RepeatedWork::Arguments{static_cast<std::uint64_t>(states.cols()), frame_.revision(),
                                     batch_.revision()};
    };
    if (!evaluations_.launch(arguments(), stream())) {
      reserve(states.cols());
      evaluations_.enqueue(arguments(), stream(), [&] {
        batch_.upload(stream());
        frame_.enqueue_apart(batch_.layout());
        batch_.download(0, states.cols() * sets, stream());
      });
    }
    wait_for(stream(), "evaluating hypotheses");
    batch_.read(costs, frame_.terms());
  }

 private:
  void use_prior(const Eigen::VectorXd* prior) {
    if (rotation_vectors_ != (prior != nullptr)) ++revision_;
    rotation_vectors_ = prior != nullptr;
    if (!prior) return;
    std::copy_n(prior->data(), prior_.size(), prior_staging_.data());
    to_device(prior_, prior_staging_, prior_.size(), stream());
  }

  FrameOnDevice frame_;
  std::unique_ptr<TileResampler> resampler_;  // for the first frame's cameras; they never change
  std::optional<BandEnds> bands_;
  HostBatch batch_;
  RepeatedWork evaluations_;
  Eigen::Index most_ = 0;  // states of an evaluation
  bool sum_of_squares_;
  ResidualMemory residual_memory_;
  DeviceLinearizer linearizer_{*this, frame_};
  DeviceDescent descent_{frame_, linearizer_};
  DeviceBuffer<double> prior_;
  PinnedBuffer<double> prior_staging_;
  bool rotation_vectors_ = false;
  std::uint64_t revision_ = 0;  // only grows, as those of the terms do
};

bool draws(const ObjectiveTerm& term) {
  return term.weight != 0 && term.objective->needs_rendering();
}

bool has_slopes(const ObjectiveTerm& term) {
  if (!draws(term)) return false;
  const auto on_device = term.objective->on_device();
  return on_device && on_device->has_slopes();
}

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

std::string why_not_linearized(const std::vector<ObjectiveTerm>& terms) {
  return std::ranges::any_of(terms, has_slopes) ? std::string() : why_neighbours_are_drawn(terms);
}

std::string why_neighbours_are_drawn(const std::vector<ObjectiveTerm>& terms) {
  for (const ObjectiveTerm& term : terms) {
    if (!draws(term) || has_slopes(term)) continue;
    return fmt::format("objective {} has no slopes of its residuals on a GPU", term.name);
  }
  return {};
}

std::unique_ptr<Cost> make_cost(const Scene& scene, std::vector<ObjectiveTerm> terms,
                                const EvaluateSettings& settings, bool residuals) {
  const std::string why = why_not_evaluated(scene, terms, settings, residuals);
  if (!why.empty()) {
    throw DeviceError("evaluate.backend: cuda: " + why +
                      ". Write `backend: cpu`, or `auto` to take what there is");
  }
  return std::make_unique<CudaCost>(scene, std::move(terms), settings);
}

}  // namespace hypotrack::cuda::internal
