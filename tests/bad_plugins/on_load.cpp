// Does harm as soon as it is opened. What it does is the name that CMake gives.
#include <signal.h>
#include <stdlib.h>
#include <unistd.h>

#include "hypotrack/plugin/plugin.hpp"

namespace {

struct OnLoad {
  OnLoad() {
#if defined(FIXTURE_segfault)
    signal(SIGSEGV, SIG_DFL);  // of a sanitizer
    raise(SIGSEGV);
#elif defined(FIXTURE_abort)
    abort();
#elif defined(FIXTURE_exit)
    exit(3);
#elif defined(FIXTURE_throw)
    throw 42;
#elif defined(FIXTURE_hang)
    while (true) pause();
#endif
  }
};

const OnLoad on_load;

}  // namespace

extern "C" __attribute__((visibility("default"))) const hypotrack::HypotrackPlugin*
hypotrack_plugin() {
  return nullptr;
}
