#include "cost/cuda/frame_on_device.hpp"

#include <cmath>

#include "cost/cuda/reserve_batch.hpp"
#include "cost/cuda/transfer.hpp"
#include "cost/term_residuals.hpp"

namespace hypotrack::cuda {

FrameOnDevice::FrameOnDevice(const Scene& scene, const std::vector<ObjectiveTerm>& terms,
                             const EvaluateSettings& settings)
    : device_(settings.device), scene_(scene), terms_(terms) {
  for (const ObjectiveTerm& term : terms_) objectives_.push_back(term.objective->on_device());
}

FrameOnDevice::~FrameOnDevice() { cudaStreamSynchronize(native(stream())); }

void FrameOnDevice::finish() {
  device_.use();
  check(cudaStreamSynchronize(native(stream())), "finishing the frame before");
}

void FrameOnDevice::prepare(const Observation& observation) {
  prepare(upload_.upload(observation, stream()));
}

void FrameOnDevice::prepare(const DeviceObservation& observation) {
  observation_ = observation;
  for (const auto& objective : objectives_) objective->prepare(observation_, stream());
}

void FrameOnDevice::reserve(std::int64_t count) {
  reserve(count, [](std::int64_t) {});
}

void FrameOnDevice::reserve(std::int64_t count, const std::function<void(std::int64_t)>& more) {
  reserve_batch(count, [&](std::int64_t hypotheses) {
    for (std::size_t i = 0; i < terms_.size(); ++i) {
      if (terms_[i].weight == 0) continue;
      objectives_[i]->reserve(scene_.layout(), device_.limits(), hypotheses);
    }
    more(hypotheses);
  });
}

template <class Enqueue>
void FrameOnDevice::add_up(BatchLayout& batch, const Enqueue& enqueue) {
  batch.add = false;
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    if (terms_[i].weight == 0) continue;
    batch.weight = terms_[i].weight;
    enqueue(*objectives_[i]);
    batch.add = true;
  }
}

void FrameOnDevice::enqueue(BatchLayout batch) {
  add_up(batch,
         [&](DeviceObjective& objective) { objective.enqueue(scene_.layout(), batch, stream()); });
  clear_costs_without_terms(batch);
}

bool FrameOnDevice::enqueue_search(BatchLayout batch, const SwarmSearch& search) {
  std::size_t count = 0, only = 0;
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    if (terms_[i].weight == 0) continue;
    only = i;
    ++count;
  }
  if (count != 1) return false;
  batch.weight = terms_[only].weight;
  return objectives_[only]->enqueue_search(scene_.layout(), batch, search, stream());
}

void FrameOnDevice::enqueue(BatchLayout batch, float* residuals) {
  const std::int64_t stride = residual_count();
  add_up(batch, [&](DeviceObjective& objective) {
    const auto factor = static_cast<float>(std::sqrt(batch.weight));
    objective.enqueue_residuals(scene_.layout(), batch, {residuals, stride, factor}, stream());
    residuals += objective.residual_count();
  });
  clear_costs_without_terms(batch);
}

void FrameOnDevice::clear_costs_without_terms(const BatchLayout& batch) {
  if (batch.add) return;
  const auto bytes = static_cast<std::size_t>(batch.count) * sizeof(double);
  check(cudaMemsetAsync(batch.costs, 0, bytes, native(stream())), "clearing costs");
}

bool FrameOnDevice::has_residuals() const {
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    if (terms_[i].weight != 0 && !objectives_[i]->has_residuals()) return false;
  }
  return true;
}

std::int64_t FrameOnDevice::residual_count() const {
  std::int64_t count = 0;
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    if (terms_[i].weight != 0) count += objectives_[i]->residual_count();
  }
  return count;
}

std::vector<ResidualRows> FrameOnDevice::pose_only_residuals() const {
  std::vector<TermRows> rows;
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    if (terms_[i].weight == 0) continue;
    rows.push_back({objectives_[i]->residual_count(), terms_[i].objective->needs_rendering()});
  }
  return pose_only_rows(rows);
}

void FrameOnDevice::enqueue_drawn(BatchLayout batch, const DrawnBatch& drawn) {
  add_up(batch, [&](DeviceObjective& objective) {
    objective.enqueue_drawn(scene_.layout(), batch, drawn, stream());
  });
}

std::uint64_t FrameOnDevice::revision() const {
  std::uint64_t sum = 0;  // of numbers that only grow
  for (const auto& objective : objectives_) sum += objective->revision();
  return sum;
}

}  // namespace hypotrack::cuda
