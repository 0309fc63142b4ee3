#include <csignal>
#include <cstddef>
#include <memory>
#include <new>

#include "plugin/running_plugin.hpp"

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

}  // namespace

void ensure_signal_stack() {
  if (t_ensured) return;
  thread_local const SignalStack stack;
  t_ensured = true;
}

}  // namespace hypotrack::detail::internal
