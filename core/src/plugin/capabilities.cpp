#include "plugin/capabilities.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace hypotrack::internal {
namespace {

constexpr std::array<Capability, 13> kKnown = {{
    {"objective", "residuals", "has residuals, which least-squares optimizers need"},
    {"objective", "slopes", "has their slopes at pixels, for analytic Jacobians"},
    {"objective", "jacobian", "has their derivatives by the state, for analytic Jacobians"},
    {"objective", "device", "computes costs on a GPU", true},
    {"objective", "device_residuals", "computes residuals on a GPU", true},
    {"optimizer", "batches", "evaluates many points at a time, in threads or on a GPU"},
    {"optimizer", "seeded", "takes random numbers; equal seeds repeat its answer"},
    {"optimizer", "needs_least_squares", "works only if every objective has residuals"},
    {"optimizer", "needs_device", "works only if the scene is evaluated on a GPU"},
    {"judge", "fits", "can be fitted to the measures of other objects"},
    {"source", "depth", "gives depth pictures"},
    {"source", "mask", "gives masks of the foreground"},
    {"source", "truth", "knows the true states and landmarks"},
}};

}  // namespace

std::span<const Capability> known_capabilities() { return kKnown; }

const Capability* find_capability(std::string_view kind, std::string_view word) {
  const auto at = std::ranges::find_if(
      kKnown, [&](const Capability& one) { return one.kind == kind && one.word == word; });
  return at == kKnown.end() ? nullptr : &*at;
}

std::string format_capabilities() {
  std::string out;
  for (const Capability& one : kKnown)
    out += fmt::format("{:10} {:20} {}{}\n", one.kind, one.word, one.meaning,
                       one.by_build ? ", in a build with CUDA" : "");
  return out;
}

std::string format_capabilities_markdown() {
  std::string out = "| kind | capability | meaning |\n|---|---|---|\n";
  for (const Capability& one : kKnown)
    out += fmt::format("| {} | `{}` | {}{} |\n", one.kind, one.word, one.meaning,
                       one.by_build ? ", in a build with CUDA" : "");
  return out;
}

}  // namespace hypotrack::internal
