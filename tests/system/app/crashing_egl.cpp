// Stands in for an OpenGL driver that crashes when it is loaded.
#include <cstdlib>

namespace {
const bool kCrashed = [] {
  std::abort();
  return true;
}();
}  // namespace

extern "C" {
__attribute__((visibility("default"))) int eglGetError() { return kCrashed ? 1 : 0; }
}
