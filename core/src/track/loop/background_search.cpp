#include "track/loop/background_search.hpp"

#include <chrono>
#include <utility>

#include "base/stop_scope.hpp"

namespace hypotrack::internal {
namespace {

/// Returns a frame with images of its own: a source may reuse them.
Frame copied(const Frame& frame) {
  Frame copy = frame;
  for (View& view : copy.views) {
    view.color = view.color.clone();
    view.mask = view.mask.clone();
    view.depth = view.depth.clone();
  }
  return copy;
}

}  // namespace

void BackgroundSearch::start(const Frame& frame, Search search) {
  unwanted_ = false;
  job_ = std::async(std::launch::async, [this, copy = copied(frame), search = std::move(search)] {
    const StopTest is_unwanted = [this] { return unwanted_.load(); };
    const StopScope scope(is_unwanted);
    return arena_.execute([&] { return search(copy); });
  });
}

std::optional<Candidate> BackgroundSearch::take() {
  if (job_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return std::nullopt;
  return job_.get();
}

void BackgroundSearch::cancel() {
  if (!job_.valid()) return;
  unwanted_ = true;
  job_.wait();
  job_ = {};
}

}  // namespace hypotrack::internal
