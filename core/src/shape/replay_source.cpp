#include "shape/replay_source.hpp"

#include <cmath>
#include <utility>

namespace hypotrack::internal {

ReplaySource::ReplaySource(const Source& from, std::vector<Frame> frames)
    : cameras_(from.cameras()),
      frame_rate_(from.frame_rate()),
      live_(from.live()),
      count_(static_cast<int>(frames.size())),
      frames_(std::move(frames)) {}

ReplaySource::ReplaySource(std::unique_ptr<Source> from, std::vector<Frame> frames)
    : cameras_(from->cameras()),
      frame_rate_(from->frame_rate()),
      live_(from->live()),
      count_(from->frame_count()),
      rest_(std::move(from)),
      frames_(std::move(frames)) {}

std::optional<Frame> ReplaySource::do_next() {
  if (next_ < frames_.size()) {
    // With a rest, frames are read once only: they need not stay in memory.
    const std::size_t i = next_++;
    return rest_ ? std::move(frames_[i]) : frames_[i];
  }
  return rest_ ? rest_->next() : std::nullopt;
}

std::vector<std::string> ReplaySource::do_notes() const {
  return rest_ ? rest_->notes() : std::vector<std::string>{};
}

std::vector<std::string> ReplaySource::do_statistics() const {
  return rest_ ? rest_->statistics() : std::vector<std::string>{};
}

std::vector<Frame> first_seconds(Source& source, double seconds) {
  const auto count = static_cast<std::size_t>(std::ceil(seconds * source.frame_rate()));
  std::vector<Frame> frames;
  while (frames.size() < count) {
    auto frame = source.next();
    if (!frame) break;
    frames.push_back(*std::move(frame));
    if (frames.back().time >= seconds) break;  // behind a gap
  }
  return frames;
}

}  // namespace hypotrack::internal
