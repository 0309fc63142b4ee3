#include "shape/frame_sample.hpp"

#include <utility>

namespace hypotrack::internal {

void FrameSample::add(const Frame& frame, const Solution& solution) {
  if (solution.status != Status::tracked) return;
  if (seen_++ % stride_ != 0) return;
  held_.push_back({frame, solution.state});
  if (held_.size() >= 2 * wanted_) thin();
}

void FrameSample::thin() {
  std::vector<TrackedFrame> kept;
  for (std::size_t i = 0; i < held_.size(); i += 2) kept.push_back(std::move(held_[i]));
  held_ = std::move(kept);
  stride_ *= 2;
}

std::vector<TrackedFrame> FrameSample::take() {
  if (held_.size() <= wanted_) return std::move(held_);
  std::vector<TrackedFrame> kept;
  for (std::size_t i = 0; i < wanted_; ++i)
    kept.push_back(std::move(held_[i * held_.size() / wanted_]));
  return kept;
}

}  // namespace hypotrack::internal
