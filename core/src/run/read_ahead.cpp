#include "run/read_ahead.hpp"

#include <oneapi/tbb/task_arena.h>

#include <chrono>
#include <utility>

namespace hypotrack::internal {
namespace {

constexpr std::size_t kFramesAhead = 4;

}  // namespace

ReadAhead::ReadAhead(Source& source, std::optional<int> limit, int threads)
    : source_(&source), items_(kFramesAhead) {
  if (source.live()) return;
  thread_ = std::jthread([this, limit, threads](const std::stop_token& stop) {
    tbb::task_arena(threads).execute([&] { read(stop, limit); });
  });
}

std::optional<Frame> ReadAhead::timed_next() {
  const auto begin = std::chrono::steady_clock::now();
  std::optional<Frame> frame = source_->next();
  seconds_ =
      seconds_ + std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return frame;
}

void ReadAhead::read(const std::stop_token& stop, std::optional<int> limit) {
  for (int i = 0; !limit || i < *limit; ++i) {
    Item item;
    try {
      item.frame = timed_next();
    } catch (...) {
      item.error = std::current_exception();
    }
    const bool last = !item.frame;
    if (!items_.push(std::move(item), stop) || last) return;
  }
  items_.push({}, stop);
}

std::optional<Frame> ReadAhead::next() {
  if (!thread_.joinable()) return timed_next();
  Item item = *items_.pop();
  if (item.error) std::rethrow_exception(item.error);
  return std::move(item.frame);
}

}  // namespace hypotrack::internal
