#include "run/crew/process_pool.hpp"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "hypotrack/api/error.hpp"

namespace hypotrack::internal {

Subprocess start_process(const Subprocess::Command& command) {
  try {
    return Subprocess(command);
  } catch (const std::system_error& error) {
    const bool too_many = error.code() == std::errc::resource_unavailable_try_again ||
                          error.code() == std::errc::not_enough_memory;
    throw OutputError(fmt::format("{}{}", error.what(), too_many ? "; use fewer --jobs" : ""));
  }
}

void ProcessPool::start(std::size_t key, const Subprocess::Command& command) {
  running_.push_back({key, start_process(command), Clock::now()});
}

std::optional<Ended> ProcessPool::take_ended() {
  for (auto it = running_.begin(); it != running_.end(); ++it) {
    const double seconds = std::chrono::duration<double>(Clock::now() - it->begin).count();
    const bool running = it->process.running();
    const bool overdue = running && limit_s_ > 0 && seconds > limit_s_;
    if (running && !overdue) continue;
    if (overdue) it->process.kill();
    const Ended ended{it->key, it->process.wait(), seconds, overdue ? limit_s_ : 0};
    running_.erase(it);
    return ended;
  }
  return std::nullopt;
}

void ProcessPool::signal(int number) const {
  for (const Running& each : running_) each.process.signal(number);
}

}  // namespace hypotrack::internal
