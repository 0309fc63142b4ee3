#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "lab/study/study_file.hpp"

namespace hypotrack::study {
inline namespace HYPOTRACK_EXPORTED internal {

/// The seed from which a rendered source draws the noise of its pictures.
struct NoiseSeed {
  std::string key;         ///< dotted path in the scene
  std::int64_t value = 1;  ///< as the scene has it
};

/// Returns whether a change affects the recording of a scene's source.
bool is_recorded(const Change& change);

/// Finds the seed of the noise in a scene with the given changes. Returns nothing if its source,
/// and what that wraps, renders no pictures.
std::optional<NoiseSeed> find_noise_seed(const StudyScene& scene,
                                         const std::vector<Change>& changes);

/// Returns the change that redraws the noise for a seed of the study. Seed 1 leaves the noise as
/// the scene has it, which is no change.
std::optional<Change> redrawn(const NoiseSeed& noise, std::int64_t seed);

}  // namespace internal
}  // namespace hypotrack::study
