#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "model/import/wire.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Reads an image as 8-bit BGR, not turned. Throws DataError if it is missing or damaged; `where`
/// names the user of the image in the message. `notes` receives what is not honoured.
cv::Mat read_texture(const std::filesystem::path& image, const std::string& where,
                     std::vector<std::string>& notes);

/// Loads the texture that a mesh file names: an embedded one (`*N`) or a file beside it.
cv::Mat load_texture(const mesh_wire::Scene& scene, const std::string& name,
                     const std::filesystem::path& mesh, std::vector<std::string>& notes);

}  // namespace internal
}  // namespace hypotrack
