#include "track/side_work.hpp"

#include <fmt/format.h>

#include <chrono>
#include <optional>
#include <utility>

#include "base/profile.hpp"
#include "base/stop_scope.hpp"
#include "plugin/plugin_call.hpp"

namespace hypotrack::internal {
namespace {

/// Does a work that a frame left. Names both in what it throws.
void do_work(const std::function<void()>& work, std::string_view name, std::optional<int> frame) {
  // A thread that waits, perhaps in another frame, may do it: it is not that frame's to stop.
  const StopTest never = [] { return false; };
  const StopScope scope(never);
  const detail::ThreadFrame of_thread(frame);
  try {
    work();
  } catch (...) {
    detail::rethrow_from(frame ? fmt::format("{} of frame {}", name, *frame) : "");
  }
}

}  // namespace

SideWork::~SideWork() {
  try {
    wait();
  } catch (...) {  // nobody is left to be told
  }
}

bool SideWork::has_thread() {
  if (!arena_.is_active()) arena_.initialize(tbb::task_arena::attach());
  return arena_.max_concurrency() > 1;
}

void SideWork::begin(std::function<void()> work) {
  wait();
  if (!has_thread()) {
    const ProfiledPart part(name_);
    return work();
  }
  runs_ = true;
  arena_.execute([&] {
    group_.run([this, work = std::move(work), frame = detail::running_frame()] {
      const auto begin = std::chrono::steady_clock::now();
      thread_ = std::this_thread::get_id();
      do_work(work, name_, frame);
      seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    });
  });
}

void SideWork::wait() {
  if (!std::exchange(runs_, false)) return;
  ProfiledPart part(name_);
  arena_.execute([&] { group_.wait(); });
  if (thread_ != std::this_thread::get_id()) part.add_beside(seconds_);
}

}  // namespace hypotrack::internal
