#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <string>

#include "model/import/wire.hpp"

namespace hypotrack {

/// Reads an image as 8-bit BGR. Throws DataError, saying that `where` wants it, if it is missing or
/// damaged.
cv::Mat read_texture(const std::filesystem::path& image, const std::string& where);

/// The texture that a mesh file names: one of its embedded ones (`*N`) or a file beside it.
cv::Mat load_texture(const mesh_wire::Scene& scene, const std::string& name,
                     const std::filesystem::path& mesh);

}  // namespace hypotrack
