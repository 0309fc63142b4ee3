#include "cost/cuda/frame_on_device.hpp"

#include <algorithm>
#include <cmath>

#include "base/profile.hpp"
#include "cost/cuda/memory/transfer.hpp"
#include "cost/cuda/reserve_batch.hpp"
#include "cost/term_residuals.hpp"

namespace hypotrack::cuda::internal {

FrameOnDevice::FrameOnDevice(const Scene& scene, const std::vector<ObjectiveTerm>& terms,
                             const EvaluateSettings& settings)
    : device_(settings.device), scene_(scene), terms_(terms) {
  for (const ObjectiveTerm& term : terms_) {
    objectives_.push_back(term.objective->on_device());
    sides_.push_back(std::make_unique<SideStream>());
    weighted_terms_ += term.weight != 0 ? 1 : 0;
  }
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    drawing_terms_ += draws(i) ? 1 : 0;
    sloped_terms_ += has_slopes(i) ? 1 : 0;
    draws_for_terms_ |= draws(i) && (drawing_terms_ > 1 || !objectives_[i]->draws());
  }
}

FrameOnDevice::~FrameOnDevice() { cudaStreamSynchronize(native(stream())); }

void FrameOnDevice::finish() {
  device_.use();
  wait_for(stream(), "finishing the frame before");
}

void FrameOnDevice::prepare(const Observation& observation) {
  prepare(upload_.upload(observation, stream()));
}

void FrameOnDevice::prepare(const DeviceObservation& observation) {
  observation_ = observation;
  drawer_.prepare(observation_);
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    const ProfiledPart part(terms_[i].name);
    objectives_[i]->prepare(observation_, stream());
  }
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
    if (draws()) drawer_.reserve(scene_.layout(), device_.limits(), hypotheses);
    more(hypotheses);
  });
}

bool FrameOnDevice::draws(std::size_t term) const {
  return terms_[term].weight != 0 && terms_[term].objective->needs_rendering();
}

bool FrameOnDevice::has_slopes(std::size_t term) const {
  return draws(term) && objectives_[term]->has_slopes();
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

/// Draws a batch in parts that fit into memory, and calls enqueue(drawn) for each.
template <class Enqueue>
void FrameOnDevice::draw_parts(const BatchLayout& batch, const Enqueue& enqueue) {
  if (!draws()) return enqueue(DrawnBatch{.count = static_cast<int>(batch.count)});
  for (std::int64_t first = 0; first < batch.count; first += drawer_.at_once()) {
    const std::int64_t count = std::min(drawer_.at_once(), batch.count - first);
    enqueue(drawer_.enqueue(scene_.layout(), batch, first, count, stream()));
  }
}

void FrameOnDevice::enqueue(BatchLayout batch) {
  if (draws_for_terms_) {
    draw_parts(batch, [&](const DrawnBatch& drawn) { enqueue_drawn(batch, drawn); });
    return;
  }
  add_up(batch,
         [&](DeviceObjective& objective) { objective.enqueue(scene_.layout(), batch, stream()); });
  clear_costs_without_terms(batch);
}

int FrameOnDevice::cost_sets(std::int64_t count) const {
  // A multiprocessor has room for two blocks at least. So most of them go on although in every term
  // a block of each hypothesis may wait for others (join_bands()).
  const bool few = count * drawing_terms_ <= device_.limits().multiprocessors;
  const bool apart = few && (!draws_for_terms_ || count <= drawer_.most_at_once());
  if (!apart || weighted_terms_ < 2) return 1;
  return weighted_terms_ + (draws_for_terms_ ? 1 : 0);
}

void FrameOnDevice::enqueue_apart(const BatchLayout& batch) {
  if (cost_sets(batch.count) == 1) return enqueue(batch);
  try {
    enqueue_beside(batch);
  } catch (...) {
    end_sides();
    throw;
  }
}

void FrameOnDevice::end_sides() const {
  for (const auto& side : sides_) side->end();
}

void FrameOnDevice::enqueue_beside(BatchLayout batch) {
  batch.add = false;
  double* const costs = batch.costs;
  DrawnBatch drawn{.count = static_cast<int>(batch.count)};
  const auto enqueue_terms = [&](bool that_draw) {
    std::int64_t set = 0;
    for (std::size_t i = 0; i < terms_.size(); ++i) {
      if (terms_[i].weight == 0) continue;
      batch.costs = costs + batch.count * set++;
      if (draws(i) != that_draw) continue;
      batch.weight = terms_[i].weight;
      sides_[i]->fork(stream());
      if (draws_for_terms_)
        objectives_[i]->enqueue_drawn(scene_.layout(), batch, drawn, sides_[i]->stream());
      else
        objectives_[i]->enqueue(scene_.layout(), batch, sides_[i]->stream());
    }
  };
  enqueue_terms(false);
  if (draws_for_terms_) {
    batch.costs = costs + batch.count * weighted_terms_;  // drawing sets them to 0
    drawn = drawer_.enqueue(scene_.layout(), batch, 0, batch.count, stream());
  }
  enqueue_terms(true);
  for (std::size_t i = 0; i < terms_.size(); ++i)
    if (terms_[i].weight != 0) sides_[i]->join(stream());
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
  draw_parts(batch, [&](const DrawnBatch& drawn) {
    float* next = residuals;
    add_up(batch, [&](DeviceObjective& objective) {
      const auto factor = static_cast<float>(std::sqrt(batch.weight));
      objective.enqueue_residuals(scene_.layout(), batch, drawn, {next, stride, factor}, stream());
      next += objective.residual_count();
    });
  });
  clear_costs_without_terms(batch);
}

DrawnBatch FrameOnDevice::draw(const BatchLayout& batch) {
  return drawer_.enqueue(scene_.layout(), batch, 0, batch.count, stream());
}

void FrameOnDevice::fork_slopes(const DrawnBatch& drawn, PixelSlope* slopes) {
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    if (!has_slopes(i)) continue;
    const auto factor = static_cast<float>(std::sqrt(terms_[i].weight));
    sides_[i]->fork(stream());
    objectives_[i]->enqueue_slopes(scene_.layout(), drawn,
                                   {slopes, sloped_terms_ * pixels(), factor}, sides_[i]->stream());
    slopes += pixels();
  }
}

void FrameOnDevice::join_slopes() {
  for (std::size_t i = 0; i < terms_.size(); ++i)
    if (has_slopes(i)) sides_[i]->join(stream());
}

void FrameOnDevice::enqueue_differences(BatchLayout batch, float* residuals, Stream stream) {
  const std::int64_t stride = difference_residual_count();
  const auto add_up = [&](const DrawnBatch& drawn) {
    float* next = residuals;
    batch.add = false;
    for (std::size_t i = 0; i < terms_.size(); ++i) {
      if (terms_[i].weight == 0 || has_slopes(i)) continue;
      batch.weight = terms_[i].weight;
      const auto factor = static_cast<float>(std::sqrt(batch.weight));
      objectives_[i]->enqueue_residuals(scene_.layout(), batch, drawn, {next, stride, factor},
                                        stream);
      batch.add = true;
      next += objectives_[i]->residual_count();
    }
  };
  if (draws_differences()) return draw_parts(batch, add_up);
  add_up({.count = static_cast<int>(batch.count)});
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

std::int64_t FrameOnDevice::difference_residual_count() const {
  std::int64_t count = 0;
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    if (terms_[i].weight != 0 && !has_slopes(i)) count += objectives_[i]->residual_count();
  }
  return count;
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
  std::uint64_t sum = drawer_.revision();  // of numbers that only grow
  for (const auto& objective : objectives_) sum += objective->revision();
  return sum;
}

}  // namespace hypotrack::cuda::internal
