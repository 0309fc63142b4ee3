#include "lab/study/noise.hpp"

#include <fmt/format.h>

#include "base/numbers.hpp"
#include "hypotrack/api/config.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack::study::internal {
namespace {

constexpr const char* kRendered = "synthetic";
constexpr std::int64_t kSeeds = std::int64_t{1} << 31;  // of a source: integers of 32 bits

std::optional<NoiseSeed> noise_seed_of(const ConfigNode& source) {
  if (!source.is_map()) return std::nullopt;
  const ConfigNode type = source.get("type");
  if (!type.is_scalar() || type.scalar() != kRendered) return noise_seed_of(source.get("source"));
  NoiseSeed noise{source.path() + ".sensor.seed"};
  const ConfigNode seed = source.get("sensor").get("seed");
  if (seed.is_scalar()) noise.value = detail::parse_integer(seed.scalar()).value_or(noise.value);
  return noise;
}

}  // namespace

bool is_recorded(const Change& change) {
  for (const std::string part : {"models", "source"})
    if (change.key == part || change.key.starts_with(part + ".")) return true;
  return false;
}

std::optional<NoiseSeed> find_noise_seed(const StudyScene& scene,
                                         const std::vector<Change>& changes) {
  std::vector<std::string> overrides;
  for (const Change& change : changes)
    if (is_recorded(change)) overrides.push_back(change.meaning());
  try {
    return noise_seed_of(ConfigNode::load_scene(scene.file, overrides).get("source"));
  } catch (const ConfigError&) {
    return std::nullopt;  // check_cells() says what is wrong, with the place in the study
  }
}

std::optional<Change> redrawn(const NoiseSeed& noise, std::int64_t seed) {
  if (seed == 1) return std::nullopt;
  const std::int64_t value = (noise.value + seed % kSeeds + kSeeds - 1) % kSeeds;
  return Change{noise.key, fmt::format("{}", value), "redraw"};
}

}  // namespace hypotrack::study::internal
