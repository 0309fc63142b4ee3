#include "hypotrack/api/stop.hpp"

#include "base/stop_scope.hpp"

namespace hypotrack {
namespace {

thread_local const StopTest* t_stop_test = nullptr;

}  // namespace

Stopped::~Stopped() = default;

void check_stop() { StopCheck()(); }

}  // namespace hypotrack

namespace hypotrack::internal {

StopScope::StopScope(const StopTest& test) : before_(t_stop_test) {
  if (test) t_stop_test = &test;
}
StopScope::~StopScope() { t_stop_test = before_; }

StopCheck::StopCheck() : test_(t_stop_test) {}
void StopCheck::operator()() const {
  if (test_ && (*test_)()) throw Stopped();
}

}  // namespace hypotrack::internal
