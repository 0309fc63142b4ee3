#include "track/side_work.hpp"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <exception>
#include <optional>
#include <thread>
#include <utility>

#include "base/profile.hpp"
#include "base/stop_scope.hpp"
#include "plugin/plugin_call.hpp"

namespace hypotrack::internal {

/// A work for the first thread that asks.
struct SideWork::Job {
  enum class State { left, begun, done };

  Job(std::function<void()> to_do, std::string_view called, std::optional<int> of_frame)
      : work(std::move(to_do)), name(called), frame(of_frame) {}

  std::function<void()> work;
  std::string_view name;
  std::optional<int> frame;  ///< that left it
  std::atomic<State> state = State::left;
  std::exception_ptr failure;
  double seconds = 0;  ///< that it took
  std::thread::id by = {};

  /// Does the work unless a thread has begun it. Returns whether it did.
  bool run() {
    State left = State::left;
    if (!state.compare_exchange_strong(left, State::begun)) return false;
    const auto begin = std::chrono::steady_clock::now();
    try {
      do_work();
    } catch (...) {
      failure = std::current_exception();
    }
    work = nullptr;  // the arena may know this object for longer than pictures may be held
    by = std::this_thread::get_id();
    seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    state = State::done;
    state.notify_all();
    return true;
  }

  void do_work() const {
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
};

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
  job_ = std::make_shared<Job>(std::move(work), name_, detail::running_frame());
  arena_.enqueue([job = job_] { job->run(); });
}

void SideWork::wait() {
  const std::shared_ptr<Job> job = std::exchange(job_, nullptr);
  if (!job) return;
  ProfiledPart part(name_);
  // Waiting as TBB does would take up other works, which may be longer.
  if (!arena_.execute([&] { return job->run(); })) {
    job->state.wait(Job::State::begun);
    // A loop of this thread may have taken it up, and then counts its time.
    if (job->by != std::this_thread::get_id()) part.add_beside(job->seconds);
  }
  if (job->failure) std::rethrow_exception(job->failure);
}

}  // namespace hypotrack::internal
