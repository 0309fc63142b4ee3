#pragma once

#include <string>
#include <vector>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// The GPUs that a command line asks for.
struct GpuList {
  std::vector<int> numbers;
  bool all_needed = true;  ///< false: those that do not answer are left out
};

/// Parses `all`, `auto` or numbers with commas. Throws ConfigError, DeviceError if there is no GPU.
GpuList parse_gpus(const std::string& text);

}  // namespace internal
}  // namespace hypotrack
