#include "plugin/running_plugin.hpp"

#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <csignal>
#include <cstddef>
#include <memory>
#include <mutex>
#include <new>
#include <string_view>
#include <utility>

namespace hypotrack::detail::internal {
namespace {

constexpr std::size_t kSize = std::size_t{1} << 16;

class SignalStack {
 public:
  SignalStack() : memory_(new (std::nothrow) std::byte[kSize]) {
    stack_t now{};
    if (!memory_ || sigaltstack(nullptr, &now) != 0 || !(now.ss_flags & SS_DISABLE)) return;
    stack_t own{};
    own.ss_sp = memory_.get();
    own.ss_size = kSize;
    sigaltstack(&own, nullptr);
  }
  ~SignalStack() {
    stack_t now{};
    if (sigaltstack(nullptr, &now) != 0 || now.ss_sp != memory_.get()) return;
    stack_t none{};
    none.ss_flags = SS_DISABLE;
    sigaltstack(&none, nullptr);
  }
  SignalStack(const SignalStack&) = delete;
  SignalStack& operator=(const SignalStack&) = delete;

 private:
  std::unique_ptr<std::byte[]> memory_;
};

// Beside the object, because asking for that takes longer.
thread_local bool t_ensured = false;

constexpr int kNoFrame = -1;
constexpr int kTrackedFrame = -2;

/// What a thread works on.
struct Running {
  const char* who = nullptr;
  const char* how = "";
  int frame = kTrackedFrame;
  bool known = false;  ///< the key leads here
};
thread_local Running t_running;

/// Leads to the calling thread's Running, or to null. A signal handler may not allocate
/// thread-local memory, as its first use in a thread does. Memory that needs no allocation
/// (initial-exec) would keep other programs, such as Python, from loading the library.
const pthread_key_t g_key = [] {
  pthread_key_t made{};
  pthread_key_create(&made, nullptr);
  return made;
}();

Running& running() {
  if (!t_running.known) t_running.known = pthread_setspecific(g_key, &t_running) == 0;
  return t_running;
}

/// Returns running() if the thread has used it; else null.
const Running* running_if_known() {
  return static_cast<const Running*>(pthread_getspecific(g_key));
}

// Of threads that track no frame themselves. Several trackers: they might help either.
std::atomic<int> g_frame{kNoFrame};
std::mutex g_running;
int g_tracked = 0;  // frames, under the mutex

/// A text of limited length.
class FixedText {
 public:
  FixedText& operator<<(std::string_view text) {
    text = text.substr(0, text_.size() - length_);
    std::copy(text.begin(), text.end(), text_.begin() + static_cast<std::ptrdiff_t>(length_));
    length_ += text.size();
    return *this;
  }
  FixedText& operator<<(int number) {
    std::array<char, 16> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
    return *this << std::string_view(digits.data(), end);
  }
  std::string_view text() const { return {text_.data(), length_}; }

 private:
  std::array<char, 4096> text_;
  std::size_t length_ = 0;
};

}  // namespace

void ensure_signal_stack() {
  if (t_ensured) return;
  thread_local const SignalStack stack;
  t_ensured = true;
}

RunningPlugin::RunningPlugin(const char* who, const char* how)
    : who_(std::exchange(running().who, who)), how_(std::exchange(running().how, how)) {
  ensure_signal_stack();
}

RunningPlugin::~RunningPlugin() {
  t_running.who = who_;
  t_running.how = how_;
}

RunningFrame::RunningFrame(int index) : of_thread_(index) {
  const std::lock_guard<std::mutex> lock(g_running);
  g_frame = ++g_tracked == 1 ? index : kNoFrame;
}
RunningFrame::~RunningFrame() {
  const std::lock_guard<std::mutex> lock(g_running);
  --g_tracked;
  g_frame = kNoFrame;
}

ThreadFrame::ThreadFrame(std::optional<int> index)
    : before_(std::exchange(running().frame, index.value_or(kNoFrame))) {}
ThreadFrame::~ThreadFrame() { t_running.frame = before_; }

std::optional<int> running_frame() {
  const Running* const own = running_if_known();
  const int frame = own && own->frame != kTrackedFrame ? own->frame : g_frame.load();
  return frame == kNoFrame ? std::nullopt : std::optional(frame);
}

void report_end(const char* ends) {
  FixedText line;
  line << "hypotrack: ";
  if (const auto frame = running_frame()) line << "frame " << *frame << ": ";
  const Running* const own = running_if_known();
  if (own && own->who) line << own->who << ": ";
  line << ends << (own ? own->how : "") << "\n";
  [[maybe_unused]] const ssize_t written =
      write(STDERR_FILENO, line.text().data(), line.text().size());
}

}  // namespace hypotrack::detail::internal
