#pragma once

#include <fmt/format.h>

#include <charconv>
#include <optional>
#include <string>
#include <string_view>

#include "base/exported.hpp"

namespace hypotrack::cuda {
inline namespace HYPOTRACK_EXPORTED internal {

inline constexpr std::string_view kGpuBefore = ", GPU ", kGpuAfter = ")";

/// Returns the name of a backend on a GPU: `cuda (NVIDIA H200, GPU 1)`.
inline std::string backend_text(std::string_view device, int number) {
  return fmt::format("cuda ({}{}{}{}", device, kGpuBefore, number, kGpuAfter);
}

/// Returns the GPU's number in a text that ends with a backend's name and more, if there is one.
inline std::optional<int> gpu_in(std::string_view text) {
  const std::size_t backend = text.rfind("cuda (");
  if (backend == std::string_view::npos) return std::nullopt;
  text.remove_prefix(backend);
  const std::size_t at = text.find(kGpuBefore);
  if (at == std::string_view::npos) return std::nullopt;
  text.remove_prefix(at + kGpuBefore.size());
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const std::string_view rest(end, static_cast<std::size_t>(text.data() + text.size() - end));
  if (error != std::errc() || !rest.starts_with(kGpuAfter)) return std::nullopt;
  return number;
}

}  // namespace internal
}  // namespace hypotrack::cuda
