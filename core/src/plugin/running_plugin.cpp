#include "plugin/running_plugin.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <cstddef>
#include <mutex>
#include <string_view>
#include <utility>

#include "plugin/signal_stack.hpp"

namespace hypotrack::detail::internal {
namespace {

// Of the calling thread. Initial-exec: a signal handler may not allocate thread-local memory.
[[gnu::tls_model("initial-exec")]] thread_local const char* t_who = nullptr;
[[gnu::tls_model("initial-exec")]] thread_local const char* t_how = "";

constexpr int kNoFrame = -1;
// Of threads that track no frame themselves. Several trackers: they might help either.
std::atomic<int> g_frame{kNoFrame};
std::mutex g_running;
int g_tracked = 0;  // frames, under the mutex

constexpr int kTrackedFrame = -2;
[[gnu::tls_model("initial-exec")]] thread_local int t_frame = kTrackedFrame;

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

RunningPlugin::RunningPlugin(const char* who, const char* how)
    : who_(std::exchange(t_who, who)), how_(std::exchange(t_how, how)) {
  ensure_signal_stack();
}

RunningPlugin::~RunningPlugin() {
  t_who = who_;
  t_how = how_;
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
    : before_(std::exchange(t_frame, index.value_or(kNoFrame))) {}
ThreadFrame::~ThreadFrame() { t_frame = before_; }

std::optional<int> running_frame() {
  const int frame = t_frame == kTrackedFrame ? g_frame.load() : t_frame;
  return frame == kNoFrame ? std::nullopt : std::optional(frame);
}

void report_end(const char* ends) {
  FixedText line;
  line << "hypotrack: ";
  if (const auto frame = running_frame()) line << "frame " << *frame << ": ";
  if (t_who) line << t_who << ": ";
  line << ends << t_how << "\n";
  [[maybe_unused]] const ssize_t written =
      write(STDERR_FILENO, line.text().data(), line.text().size());
}

}  // namespace hypotrack::detail::internal
