#include "cost/linearize/linearizer_pool.hpp"

#include <utility>

namespace hypotrack::internal {

void LinearizerPool::prepare(const Observation& observation) {
  observation_ = &observation;
  for (Entry& entry : free_) entry.is_prepared = false;
}

LinearizerPool::Entry LinearizerPool::take() {
  const std::lock_guard lock(mutex_);
  if (free_.empty()) return {make_()};
  Entry entry = std::move(free_.back());
  free_.pop_back();
  return entry;
}

void LinearizerPool::use(const std::function<void(HostLinearizer&)>& work) {
  Entry entry = take();
  if (!entry.is_prepared) entry.linearizer->prepare(*observation_);
  entry.is_prepared = true;
  work(*entry.linearizer);
  const std::lock_guard lock(mutex_);
  free_.push_back(std::move(entry));
}

}  // namespace hypotrack::internal
