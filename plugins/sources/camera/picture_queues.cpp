#include "picture_queues.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "newest_pair.hpp"

namespace hypotrack::live {
namespace {

std::chrono::steady_clock::time_point clock_time(std::int64_t stamp) {
  return std::chrono::steady_clock::time_point(std::chrono::nanoseconds(stamp));
}

}  // namespace

PictureQueues::PictureQueues(const std::vector<std::string>& names) : queues_(names.size()) {
  for (std::size_t i = 0; i < names.size(); ++i) queues_[i].name = names[i];
}

void PictureQueues::opened(std::size_t device, double stated_rate,
                           std::vector<std::string> refused) {
  const std::lock_guard lock(mutex_);
  Queue& d = queues_[device];
  if (d.times_opened++ > 0) ++d.counts.reconnects;
  d.stated_rate = stated_rate;
  d.refused = std::move(refused);
}

void PictureQueues::add(std::size_t device, Picture picture) {
  constexpr std::size_t kMost = 8;
  {
    const std::lock_guard lock(mutex_);
    Queue& d = queues_[device];
    if (d.arrived > 0 && picture.stamp <= d.last) return;  // the driver's clock jumped
    if (d.arrived == 0) d.first = picture.stamp;
    d.last = picture.stamp;
    ++d.arrived;
    ++d.counts.pictures;
    d.size = picture.image.size();
    d.problem.clear();
    d.waiting.push_back(std::move(picture));
    if (d.waiting.size() > kMost) {
      d.waiting.pop_front();
      ++d.counts.dropped;
    }
  }
  changed_.notify_all();
}

void PictureQueues::add_damaged(std::size_t device) {
  const std::lock_guard lock(mutex_);
  ++queues_[device].counts.damaged;
}

void PictureQueues::lost(std::size_t device, std::string problem) {
  {
    const std::lock_guard lock(mutex_);
    queues_[device].problem = std::move(problem);
  }
  changed_.notify_all();
}

void PictureQueues::ended(std::size_t device) {
  {
    const std::lock_guard lock(mutex_);
    queues_[device].ended = true;
  }
  changed_.notify_all();
}

bool PictureQueues::sleep(double seconds) {
  std::unique_lock lock(mutex_);
  return !changed_.wait_for(lock, std::chrono::duration<double>(seconds), [&] { return stopped_; });
}

bool PictureQueues::stopped() {
  const std::lock_guard lock(mutex_);
  return stopped_;
}

std::string PictureQueues::wait_for_first(int count, std::int64_t deadline) {
  std::unique_lock lock(mutex_);
  const auto failed = [](const Queue& d) { return d.arrived == 0 && !d.problem.empty(); };
  changed_.wait_until(lock, clock_time(deadline), [&] {
    return std::ranges::any_of(queues_, failed) ||
           std::ranges::all_of(queues_, [&](const Queue& d) { return d.arrived >= count; });
  });
  for (const Queue& d : queues_) {
    if (failed(d)) return d.problem;
  }
  for (const Queue& d : queues_) {
    if (d.arrived == 0) return fmt::format("{}: no whole picture arrives", d.name);
  }
  return {};
}

double PictureQueues::rate(std::size_t device) {
  const std::lock_guard lock(mutex_);
  const Queue& d = queues_[device];
  if (d.stated_rate > 0) return d.stated_rate;
  return d.arrived < 2 ? 0 : 1e9 * (d.arrived - 1) / static_cast<double>(d.last - d.first);
}

cv::Size PictureQueues::size(std::size_t device) {
  const std::lock_guard lock(mutex_);
  return queues_[device].size;
}

std::optional<std::vector<std::size_t>> PictureQueues::places(std::int64_t tolerance) const {
  const std::deque<Picture>& first = queues_[0].waiting;
  if (queues_.size() == 1) {
    if (first.empty()) return std::nullopt;
    return std::vector{first.size() - 1};
  }
  const auto pair = newest_pair(first, queues_[1].waiting, tolerance);
  if (!pair) return std::nullopt;
  return std::vector{pair->first, pair->second};
}

/// Drops the pictures up to a time.
void PictureQueues::forget(Queue& device, std::int64_t until) {
  while (!device.waiting.empty() && device.waiting.front().stamp <= until) {
    device.waiting.pop_front();
    ++device.counts.dropped;
  }
}

std::vector<Picture> PictureQueues::take(std::int64_t after, std::int64_t tolerance,
                                         std::int64_t deadline) {
  std::unique_lock lock(mutex_);
  std::optional<std::vector<std::size_t>> found;
  changed_.wait_until(lock, clock_time(deadline), [&] {
    forget(queues_[0], after);
    found = places(tolerance);
    return found.has_value();
  });
  if (!found) return {};
  std::vector<Picture> pictures;
  for (std::size_t i = 0; i < queues_.size(); ++i) {
    Queue& d = queues_[i];
    pictures.push_back(std::move(d.waiting[(*found)[i]]));
    forget(d, pictures.back().stamp);
    --d.counts.dropped;
  }
  if (!std::exchange(any_pair_, true)) {
    for (Queue& d : queues_) {
      d.counts = {.pictures = 1 + static_cast<int>(d.waiting.size())};
    }
  }
  return pictures;
}

std::string PictureQueues::problem(std::int64_t tolerance) {
  const std::lock_guard lock(mutex_);
  for (const Queue& d : queues_) {
    if (!d.problem.empty()) return d.problem;
  }
  for (const Queue& d : queues_) {
    if (d.waiting.empty()) return fmt::format("{}: no picture arrives", d.name);
  }
  return fmt::format(
      "the newest pictures of left and right are {:.1f} ms apart; a pair may be {:.1f} "
      "(tolerance_ms)",
      1e-6 * static_cast<double>(std::abs(queues_.front().last - queues_.back().last)),
      1e-6 * static_cast<double>(tolerance));
}

DeviceCounts PictureQueues::counts(std::size_t device) {
  const std::lock_guard lock(mutex_);
  return queues_[device].counts;
}

std::vector<std::string> PictureQueues::refused(std::size_t device) {
  const std::lock_guard lock(mutex_);
  return queues_[device].refused;
}

void PictureQueues::tell(std::size_t device, std::string line) {
  const std::lock_guard lock(mutex_);
  queues_[device].refused.push_back(std::move(line));
}

std::vector<bool> PictureQueues::stop(std::int64_t deadline) {
  std::unique_lock lock(mutex_);
  stopped_ = true;
  changed_.notify_all();
  changed_.wait_until(lock, clock_time(deadline),
                      [&] { return std::ranges::all_of(queues_, &Queue::ended); });
  std::vector<bool> ended;
  for (const Queue& d : queues_) ended.push_back(d.ended);
  return ended;
}

}  // namespace hypotrack::live
