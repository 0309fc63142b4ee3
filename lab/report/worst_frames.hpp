#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Limits on a run's pictures in the page.
struct PictureLimits {
  int count = 3;
  int longest_side = 640;  ///< pixels; larger pictures are scaled down
  int quality = 80;        ///< of the JPEG, 0 to 100
};

/// Returns the pictures worst_<frame>.jpg of a run folder, by frame: [{frame, src:
/// "data:image/jpeg..."}]. Throws DataError on a file that is no picture.
nlohmann::ordered_json worst_frames(const std::filesystem::path& run, const PictureLimits& limits);

}  // namespace internal
}  // namespace hypotrack
