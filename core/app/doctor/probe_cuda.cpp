#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <string>
#include <string_view>

#include "cost/cuda/device.hpp"
#include "doctor/probe.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack::doctor {
namespace {

/// Returns the version of NVIDIA's kernel module, such as 580.95.05; empty if it is not loaded.
std::string driver_version() {
  std::ifstream in("/proc/driver/nvidia/version");
  for (std::string word; in >> word;)
    if (std::isdigit(static_cast<unsigned char>(word.front())) &&
        word.find('.') != std::string::npos)
      return word;
  return {};
}

/// Returns true if a reason says that something is absent, false if something fails.
bool says_absent(std::string_view reason) {
  return reason.starts_with("there is no NVIDIA") || reason.starts_with("this hypotrack was built");
}

std::string device_text(const cuda::Device& device) {
  constexpr double kGiB = 1024.0 * 1024 * 1024;
  const int capability = device.limits().compute_capability;
  std::string text =
      fmt::format("{}, compute capability {}.{}", device.name(), capability / 10, capability % 10);
  if (const auto free = cuda::free_memory())
    text += fmt::format(", {:.1f} GiB free", static_cast<double>(*free) / kGiB);
  return text;
}

}  // namespace

Check probe_cuda() {
  const std::string built_for = HYPOTRACK_CUDA_TARGET;
  const std::string cpu = "scenes are evaluated on the CPU until then";
  if (built_for.empty())
    return {.state = State::missing,
            .found = cuda::why_no_device(),
            .fix = std::string(HYPOTRACK_WHY_NO_CUDA) +
                   "; then build again, or install the package hypotrack-cuda; " + cpu};
  const std::string driver = driver_version();
  const std::string build =
      fmt::format("{}{}; built for {}", driver.empty() ? "" : "; driver ", driver, built_for);
  if (const std::string why = cuda::why_no_device(); !why.empty())
    return {.state = says_absent(why) ? State::missing : State::broken,
            .found = why + build,
            .fix = "an NVIDIA GPU with a driver for that CUDA; " + cpu};
  try {
    const cuda::Device device(0);
    int count = 1;
    while (cuda::why_no_device(count).empty()) ++count;
    return {.found = fmt::format("{}{}{}", device_text(device),
                                 count > 1 ? fmt::format(", the first of {}", count) : "", build)};
  } catch (const DeviceError& e) {
    return {.state = State::broken,
            .found = e.what() + build,
            .fix = "build hypotrack again on this machine, or update the driver; " + cpu};
  }
}

}  // namespace hypotrack::doctor
