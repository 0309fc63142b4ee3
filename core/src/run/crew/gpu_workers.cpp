#include "run/crew/gpu_workers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <thread>
#include <utility>

#include "hypotrack/api/files.hpp"

namespace hypotrack::internal {
namespace {

constexpr std::chrono::milliseconds kPoll{5};
constexpr std::chrono::seconds kAnswer{120};  // in which a worker says that its GPU answers
constexpr double kGrace_s = 5;                // in which a run ends itself at its time limit
constexpr int kInterrupted = 130;

void append(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::app | std::ios::binary) << text;
}

std::string runs_text(std::size_t count) {
  return fmt::format("{} run{}", count, count == 1 ? "" : "s");
}

}  // namespace

std::vector<GpuState> GpuWorkers::start() {
  for (const int gpu : settings_.gpus) start_worker(seat(gpu));
  std::vector<GpuState> states;
  for (const int gpu : settings_.gpus) {
    Seat& each = seat(gpu);
    while (!each.ready && !each.gone()) {
      look_at(each);
      std::this_thread::sleep_for(kPoll);
    }
    states.push_back(each.gpu);
  }
  notes_.clear();  // the caller says it
  return states;
}

void GpuWorkers::add(Job job) { waiting_.push_back({std::move(job)}); }

std::optional<Ended> GpuWorkers::take_ended() {
  for (auto& [gpu, each] : seats_) look_at(each);
  deal();
  if (ended_.empty()) return std::nullopt;
  const Ended ended = ended_.front();
  ended_.pop_front();
  return ended;
}

std::size_t GpuWorkers::size() const {
  std::size_t count = waiting_.size() + ended_.size();
  for (const auto& [gpu, each] : seats_) count += each.running.size() + each.suspects.size();
  return count;
}

void GpuWorkers::interrupt() {
  interrupted_ = true;
  for (auto& [gpu, each] : seats_) {
    if (each.worker) each.worker->signal(SIGINT);
    for (const Held& held : std::exchange(each.suspects, {})) drop(held);
  }
  for (const Held& held : std::exchange(waiting_, {})) drop(held);
}

/// Ends a run that no worker makes after an interrupt.
void GpuWorkers::drop(const Held& held) {
  const bool had_begun = held.begin != Clock::time_point{};
  append(held.job.log,
         fmt::format("hypotrack: interrupted {}\n",
                     had_begun ? "after its worker had ended" : "before the first frame"));
  ended_.push_back({held.job.key, {kInterrupted, 0}});
}

void GpuWorkers::kill() {
  seats_.clear();
  waiting_.clear();
  ended_.clear();
}

GpuWorkers::Seat& GpuWorkers::seat(int gpu) { return seats_.try_emplace(gpu, gpu).first->second; }

void GpuWorkers::start_worker(Seat& seat) {
  seat.log = logs_ / fmt::format("worker_{}_{}.txt", seat.gpu.number, ++started_);
  seat.ready = seat.closing = false;
  seat.started = Clock::now();
  seat.worker = std::make_unique<GpuWorker>(settings_, seat.gpu.number, seat.log);
}

void GpuWorkers::look_at(Seat& seat) {
  if (!seat.worker) return;
  const bool had_ended = !seat.worker->running();  // asked first: its last answers are there then
  take_answers(seat);
  if (had_ended) return bury(seat);
  if (!seat.ready && Clock::now() - seat.started > kAnswer) {
    seat.gpu.why = fmt::format("it has not answered for {} s", kAnswer.count());
    seat.worker->kill();
    return bury(seat);
  }
  end_overdue(seat);
}

void GpuWorkers::take_answers(Seat& seat) {
  for (const WorkerAnswer& answer : seat.worker->take_answers()) take(seat, answer);
}

void GpuWorkers::take(Seat& seat, const WorkerAnswer& answer) {
  using Kind = WorkerAnswer::Kind;
  if (answer.kind == Kind::absent) {
    seat.gpu.why = answer.text;
    return;
  }
  if (answer.kind == Kind::ready) {
    seat.ready = true;
    seat.gpu.name = answer.text;
    return judge_suspects(seat);
  }
  const auto held =
      std::ranges::find(seat.running, answer.key, [](const Held& each) { return each.job.key; });
  if (held == seat.running.end()) return;
  if (answer.kind == Kind::lost) {
    held->failed = true;
    seat.suspects.push_back(std::move(*held));
    seat.closing = true;
    seat.worker->close();
  } else {
    finish(seat, *held, {answer.code, 0},
           answer.kind == Kind::overdue ? settings_.time_limit_s : 0);
  }
  seat.running.erase(held);
}

/// Ends a worker with a run that does not heed its time limit. The others begin anew.
void GpuWorkers::end_overdue(Seat& seat) {
  const auto overdue = [&](const Held& held) {
    const std::chrono::duration<double> time = Clock::now() - held.begin;
    return settings_.time_limit_s > 0 && time.count() > settings_.time_limit_s + kGrace_s;
  };
  if (std::ranges::none_of(seat.running, overdue)) return;
  seat.worker->kill();
  take_answers(seat);
  for (Held& held : std::exchange(seat.running, {})) {
    if (overdue(held))
      finish(seat, held, {128 + SIGKILL, SIGKILL}, settings_.time_limit_s);
    else if (interrupted_)
      drop(held);
    else
      waiting_.push_front(std::move(held));
  }
  if (!seat.suspects.empty()) return bury(seat);
  seat.worker.reset();
}

/// Takes leave of a worker that has ended, and starts the next one if runs are to be made again.
void GpuWorkers::bury(Seat& seat) {
  seat.end = seat.worker->wait();
  seat.words = read_whole(seat.log).value_or("");
  seat.worker.reset();
  std::ranges::move(std::exchange(seat.running, {}), std::back_inserter(seat.suspects));
  const bool is_needed = seat.ready && !seat.suspects.empty() && !interrupted_;
  if (is_needed) return start_worker(seat);
  if (seat.gpu.why.empty()) {
    const std::string words = seat.words.substr(0, seat.words.find('\n'));
    seat.gpu.why = fmt::format("its worker ended with exit code {}{}{}", seat.end.code,
                               words.empty() ? "" : ": ", words);
  }
  judge_suspects(seat);
}

/// Decides on the runs that a worker had when it ended, now that the GPU has answered or is gone.
void GpuWorkers::judge_suspects(Seat& seat) {
  std::vector<Held> suspects = std::exchange(seat.suspects, {});
  if (interrupted_) {
    for (const Held& held : suspects) drop(held);
    return;
  }
  const std::string count = runs_text(suspects.size());
  if (seat.gone()) {
    if (!seat.gpu.name.empty())  // it had answered
      notes_.push_back(fmt::format("note: GPU {} is lost: {}{}", seat.gpu.number, seat.gpu.why,
                                   suspects.empty() ? "" : "; it gives back " + count));
  } else if (suspects.size() == 1) {
    Held& guilty = suspects.front();
    if (!guilty.failed) append(guilty.job.log, seat.words);
    return finish(seat, guilty, guilty.failed ? Subprocess::End{1, 0} : seat.end);
  } else if (!suspects.empty()) {
    notes_.push_back(
        fmt::format("note: the worker of GPU {} ended; its {} are made again, each "
                    "alone",
                    seat.gpu.number, count));
  }
  for (Held& held : suspects) {
    held.alone = !seat.gone();
    held.failed = false;
    waiting_.push_front(std::move(held));
  }
}

void GpuWorkers::finish(const Seat& seat, const Held& held, Subprocess::End end, double limit_s) {
  const std::chrono::duration<double> time = Clock::now() - held.begin;
  ended_.push_back({held.job.key, end, time.count(), limit_s, seat.gpu.number});
}

/// Returns whether a GPU may get a further job, which is to be alone there or not.
bool GpuWorkers::may_take(const Seat& seat, bool alone) const {
  if (seat.gone() || seat.closing) return false;
  if (alone) return seat.running.empty();
  if (std::ranges::any_of(seat.running, &Held::alone)) return false;
  const std::size_t gpus = std::max<std::size_t>(1, settings_.gpus.size());
  const std::size_t share = (static_cast<std::size_t>(settings_.jobs) + gpus - 1) / gpus;
  return seat.running.size() < share;
}

/// Returns the GPU with the fewest runs that may take one more; null: none at present.
GpuWorkers::Seat* GpuWorkers::free_seat(const Held& held) {
  Seat* best = nullptr;
  const std::vector<int> own{*held.job.gpu};
  for (const int gpu : settings_.gpus.empty() ? own : settings_.gpus) {
    Seat& each = seat(gpu);
    if (!may_take(each, held.alone)) continue;
    if (!each.worker) start_worker(each);
    if (each.ready && (!best || each.running.size() < best->running.size())) best = &each;
  }
  return best;
}

std::optional<int> GpuWorkers::next_gpu() const {
  const Seat* best = nullptr;
  for (const int gpu : settings_.gpus) {
    const auto it = seats_.find(gpu);
    if (it == seats_.end() || !it->second.ready || !may_take(it->second)) continue;
    if (!best || it->second.running.size() < best->running.size()) best = &it->second;
  }
  return best ? std::optional(best->gpu.number) : std::nullopt;
}

/// Returns false, after it noted the failure, if every GPU that could make the run is gone.
bool GpuWorkers::can_be_made(const Held& held) {
  std::vector<std::string> reasons;
  const std::vector<int> own{*held.job.gpu};
  for (const int gpu : settings_.gpus.empty() ? own : settings_.gpus) {
    const Seat& each = seat(gpu);
    if (!each.gone()) return true;
    reasons.push_back(fmt::format("GPU {}: {}", gpu, each.gpu.why));
  }
  append(held.job.log,
         fmt::format("hypotrack: no GPU is left for the run: {}\n", fmt::join(reasons, "; ")));
  ended_.push_back({held.job.key, {1, 0}});
  return false;
}

void GpuWorkers::deal() {
  for (auto held = waiting_.begin(); held != waiting_.end();) {
    if (!can_be_made(*held)) {
      held = waiting_.erase(held);
      continue;
    }
    Seat* const free = free_seat(*held);
    if (!free && held->alone) return;  // those behind it would keep the GPU busy
    if (!free) {
      ++held;
      continue;
    }
    held->begin = Clock::now();
    Job job = held->job;
    if (!settings_.gpus.empty())
      job.set.push_back(fmt::format("evaluate.device={}", free->gpu.number));
    free->worker->give(job);
    free->running.push_back(std::move(*held));
    held = waiting_.erase(held);
  }
}

}  // namespace hypotrack::internal
