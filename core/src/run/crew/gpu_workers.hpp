#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/exported.hpp"
#include "run/crew/gpu_worker.hpp"
#include "run/crew/process_pool.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// A GPU and what a worker said of it.
struct GpuState {
  int number = 0;
  std::string name;  ///< `NVIDIA H200`; empty if it never answered
  std::string why;   ///< reason why it cannot be used; empty if it can
};

/// Deals jobs evenly to GPUs, each with a worker process in which its runs share the GPU.
///
/// A worker that ends, or whose GPU fails, gives back the runs that it was making, and is started
/// anew. If the GPU answers, each of these runs is made again alone, so that the guilty one is
/// found: it fails. If not, the other GPUs make them.
class GpuWorkers {
 public:
  /// The settings must outlive it. `logs`: folder for what workers print.
  GpuWorkers(const CrewSettings& settings, std::filesystem::path logs)
      : settings_(settings), logs_(std::move(logs)) {}

  /// Starts a worker on each of the settings' GPUs and waits for their answers, in their order.
  std::vector<GpuState> start();
  /// Returns the GPU of the settings that takes the next job; none if it is not known.
  std::optional<int> next_gpu() const;
  /// Takes a job with a GPU.
  void add(Job job);
  /// Returns a job that has ended, if any. Throws OutputError if a worker cannot be started.
  std::optional<Ended> take_ended();
  std::size_t size() const;
  /// Returns what happened to workers since the last call.
  std::vector<std::string> take_notes() { return std::exchange(notes_, {}); }
  /// Tells all runs to end early, and drops those that no worker makes, now or later.
  void interrupt();
  /// Ends all workers at once, and forgets their jobs.
  void kill();

 private:
  using Clock = std::chrono::steady_clock;
  struct Held {
    Job job;
    Clock::time_point begin{};
    bool alone = false;   ///< it may have ended a worker
    bool failed = false;  ///< it has ended by an error
  };
  struct Seat {
    explicit Seat(int number) : gpu{number, {}, {}} {}
    GpuState gpu;
    std::unique_ptr<GpuWorker> worker;
    Clock::time_point started;
    std::filesystem::path log;
    bool ready = false;
    bool closing = false;        ///< it gets no more jobs
    std::vector<Held> running;   ///< by the worker
    std::vector<Held> suspects;  ///< run when the worker before ended
    Subprocess::End end;         ///< of that worker
    std::string words;           ///< printed by it
    bool gone() const { return !gpu.why.empty(); }
  };

  Seat& seat(int gpu);
  void start_worker(Seat& seat);
  void look_at(Seat& seat);
  void take_answers(Seat& seat);
  void take(Seat& seat, const WorkerAnswer& answer);
  void end_overdue(Seat& seat);
  void bury(Seat& seat);
  void judge_suspects(Seat& seat);
  void drop(const Held& held);
  void finish(const Seat& seat, const Held& held, Subprocess::End end, double limit_s = 0);
  Seat* free_seat(const Held& held);
  bool may_take(const Seat& seat, bool alone = false) const;
  bool can_be_made(const Held& held);
  void deal();

  const CrewSettings& settings_;
  std::filesystem::path logs_;
  int started_ = 0;
  bool interrupted_ = false;
  std::map<int, Seat> seats_;
  std::deque<Held> waiting_;
  std::deque<Ended> ended_;
  std::vector<std::string> notes_;
};

}  // namespace internal
}  // namespace hypotrack
