#include "cost/cuda/descend/device_descent.hpp"

#include <algorithm>
#include <atomic>

#include "base/profile.hpp"
#include "cost/backends.hpp"
#include "cost/cuda/memory/transfer.hpp"
#include "hypotrack/api/stop.hpp"

namespace hypotrack::cuda::internal {

StreamEvent::StreamEvent() {
  check(cudaEventCreateWithFlags(&event_, cudaEventDisableTiming), "creating an event");
}
StreamEvent::~StreamEvent() { cudaEventDestroy(event_); }
void StreamEvent::record(Stream stream) {
  check(cudaEventRecord(event_, native(stream)), "recording an event");
}
void StreamEvent::wait() const {
  const ProfiledPart part("wait for the GPU");
  check(cudaEventSynchronize(event_), "a search by least squares");
}

bool DeviceDescent::can_run(const DampedSettings& settings, std::int32_t dimension,
                            std::size_t searches, bool rotation_vectors) {
  const SceneLayout& scene = frame_.scene();
  if (dimension > kMostDescentDimensions || settings.trials > kMostTrials) return false;
  if (!frame_.has_slopes() || frame_.draws_differences()) return false;
  // Otherwise some models rest, and points lack their numbers.
  const bool moves_all = dimension == scene.dimension - (rotation_vectors ? scene.model_count : 0);
  return moves_all && (searches == 1 || searches <= linearizer_.most_together(searches));
}

void DeviceDescent::reserve(const DampedSettings& settings, std::int32_t dimension,
                            std::size_t searches) {
  const auto k = static_cast<std::int64_t>(searches), d = std::int64_t{dimension};
  const std::int64_t t = settings.trials, s = frame_.scene().dimension;
  job_ = {.searches = static_cast<std::int32_t>(k),
          .dimension = dimension,
          .trials = settings.trials,
          .state_size = frame_.scene().dimension,
          .models = frame_.scene().model_count,
          .model_layouts = frame_.scene().models,
          .prior = nullptr,
          .regions = grow(regions_, k * 4 * d),
          .states = grow(states_, k),
          .points = grow(points_, k * (2 + t) * d),
          .trial_states = grow(trial_states_, k * t * s),
          .costs = grow(costs_, k * t * frame_.cost_sets(k * t)),
          .cost_sets = frame_.cost_sets(k * t),
          .centres = grow(centres_, k * (d + 2) * s),
          .per_step = grow(per_step_, k * d),
          .blurs = grow(blurs_, k),
          .rests = grow(rests_, k),
          .row_sums = nullptr,
          .gram_sums = nullptr,
          .answers = grow(answers_, k),
          .answer_points = grow(answer_points_, k * d)};
  grow(posed_costs_, k * (d + 2));
  grow(regions_staging_, k * 4 * d);
}

void DeviceDescent::upload(std::span<const Descent> searches) {
  double* next = regions_staging_.data();
  for (const Descent& search : searches) {
    for (const double* part : {search.start, search.lower, search.upper, search.spread})
      next = std::copy_n(part, job_.dimension, next);
  }
  const auto count = static_cast<std::size_t>(next - regions_staging_.data());
  to_device(regions_, regions_staging_, count, frame_.stream());
}

void DeviceDescent::run(const DampedSettings& settings, std::int32_t dimension,
                        std::span<Descent> searches, const double* prior,
                        const std::function<bool()>& ends) {
  frame_.device().use();
  reserve(settings, dimension, searches.size());
  job_.prior = prior;
  upload(searches);
  enqueue_begin(job_, settings, frame_.stream());
  for (std::size_t step = 0;; ++step) {
    enqueue_step();
    step_ends_[step % 2].record(frame_.stream());
    if (step > 0) {
      step_ends_[(step - 1) % 2].wait();
      if (all_ended()) break;
      check_stop();
    }
    if (ends()) {
      wait_for(frame_.stream(), "a search by least squares");
      break;
    }
  }
  read(searches);
}

void DeviceDescent::enqueue_step() {
  enqueue_evaluation();
  enqueue_linearization();
}

void DeviceDescent::enqueue_evaluation() {
  const auto arguments = [&] {
    const auto shape = static_cast<std::uint64_t>(std::int64_t{job_.searches} << 32 |
                                                  job_.trials << 16 | job_.dimension);
    return RepeatedWork::Arguments{shape, frame_.revision(), revision_, job_.prior ? 1u : 0u};
  };
  if (evaluations_.launch(arguments(), frame_.stream())) return;
  frame_.reserve(trials());
  job_.cost_sets = frame_.cost_sets(trials());
  evaluations_.enqueue(arguments(), frame_.stream(), [&] {
    frame_.enqueue_apart({trial_states_.data(), trials(), costs_.data(), 0, nullptr, false});
    enqueue_costs_taken(job_, frame_.stream());
  });
}

void DeviceDescent::enqueue_linearization() {
  const auto arguments = [&] {
    const auto shape = static_cast<std::uint64_t>(std::int64_t{job_.searches} << 32 |
                                                  job_.trials << 16 | job_.dimension);
    return RepeatedWork::Arguments{shape, frame_.revision(), linearizer_.revision(),
                                   revision_ << 1 | (job_.prior ? 1u : 0u)};
  };
  if (linearizations_.launch(arguments(), frame_.stream())) return;
  linearizer_.reserve(job_.searches, job_.dimension);
  job_.row_sums = linearizer_.row_sums();
  job_.gram_sums = linearizer_.gram_sums();
  linearizations_.enqueue(arguments(), frame_.stream(), [&] {
    linearizer_.enqueue(
        {.points = job_.searches,
         .columns = job_.dimension,
         .states = {centres_.data(), job_.searches, posed_costs_.data(), 0, nullptr, false},
         .per_step = per_step_.data(),
         .blurs = blurs_.data(),
         .rests = rests_.data()});
    enqueue_trials(job_, frame_.stream());
  });
}

bool DeviceDescent::all_ended() const {
  const std::span answers(answers_.data(), static_cast<std::size_t>(job_.searches));
  const bool ended = std::ranges::all_of(answers, [](const DescentAnswer& one) {
    return *static_cast<const volatile std::int32_t*>(&one.ended) != 0;
  });
  std::atomic_thread_fence(std::memory_order_acquire);
  return ended;
}

void DeviceDescent::read(std::span<Descent> searches) const {
  for (std::size_t k = 0; k < searches.size(); ++k) {
    const DescentAnswer& answer = answers_.data()[k];
    if (answer.refused != 0)
      refuse_cost(frame_.terms().front(), static_cast<Eigen::Index>(k),
                  "(or one after it) returned NaN or -infinity");
    searches[k].cost = answer.cost;
    searches[k].evaluations = answer.evaluations;
    std::copy_n(answer_points_.data() + k * static_cast<std::size_t>(job_.dimension),
                job_.dimension, searches[k].point);
  }
}

}  // namespace hypotrack::cuda::internal
