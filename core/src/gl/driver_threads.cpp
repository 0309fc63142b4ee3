#include <fmt/format.h>

#include <algorithm>
#include <latch>
#include <system_error>
#include <thread>
#include <vector>

#include "base/machine.hpp"
#include "base/system_problem.hpp"
#include "gl/egl_context.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack::gl::internal {

void expect_driver_threads() {
  constexpr int kMost = 16, kOthers = 2;  // of llvmpipe; for shaders and files
  const int count = std::min(core_count(), kMost) + kOthers;
  std::latch all_started(1);
  std::vector<std::jthread> threads;  // all at once, as the driver has them
  std::string problem;
  try {
    for (int i = 0; i < count; ++i) threads.emplace_back([&] { all_started.wait(); });
  } catch (const std::system_error& error) {
    problem = described(error);
  }
  all_started.count_down();
  if (problem.empty()) return;
  throw DeviceError(
      fmt::format("no OpenGL context: its driver needs {} threads: {}", count, problem));
}

}  // namespace hypotrack::gl::internal
