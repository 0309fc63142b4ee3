#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string_view>

#include "camera/pictures/orientation.hpp"
#include "camera/pictures/picture_header.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/files.hpp"
#include "hypotrack/api/media.hpp"
#include "model/import/steps.hpp"

namespace hypotrack::internal {
namespace {

/// Decodes a compressed image; returns an empty one if it is damaged. Throws DataError, naming
/// `where`, if it is too large.
cv::Mat decode(std::string_view bytes, const std::string& where) {
  if (const std::string problem = problem_of_size(bytes); !problem.empty())
    throw DataError(where + ": the texture " + problem);
  if (bytes.empty()) return {};
  try {
    const cv::Mat raw(1, static_cast<int>(bytes.size()), CV_8UC1, const_cast<char*>(bytes.data()));
    return decode_image(raw, cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION);
  } catch (const cv::Exception&) {
    return {};
  }
}

/// Notes that a picture asks to be turned. Programs that draw meshes do not, browsers do.
void note_orientation(std::string_view bytes, const std::string& name,
                      std::vector<std::string>& notes) {
  const int orientation = orientation_of(bytes);
  if (orientation == 1) return;
  const std::string note = fmt::format(
      "{}: its EXIF orientation is {}: it is used as it is stored, as most programs for meshes do; "
      "store it upright (exiftool -Orientation= -overwrite_original FILE)",
      name, orientation);
  if (std::ranges::find(notes, note) == notes.end()) notes.push_back(note);
}

cv::Mat decode_embedded(const mesh_wire::Texture& texture, const std::string& where,
                        std::vector<std::string>& notes) {
  cv::Mat image;
  if (texture.width == 0) {
    image = decode(texture.bytes, where);
    note_orientation(texture.bytes, "the texture inside the file", notes);
  } else {
    const std::size_t size = std::size_t{4} * texture.width * texture.height;
    if (texture.bytes.size() == size && texture.width < 1 << 16 && texture.height < 1 << 16) {
      const cv::Mat pixels(static_cast<int>(texture.height), static_cast<int>(texture.width),
                           CV_8UC4, const_cast<char*>(texture.bytes.data()));
      if (!pixels.empty()) cv::cvtColor(pixels, image, cv::COLOR_BGRA2BGR);
    }
  }
  if (image.empty()) {
    throw DataError(where +
                    ": the texture inside the mesh file is damaged or of a format that "
                    "OpenCV does not read; `texture` can name another image");
  }
  return image;
}

}  // namespace

cv::Mat read_texture(const std::filesystem::path& image, const std::string& where,
                     std::vector<std::string>& notes) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(image, error)) {
    throw DataError(
        fmt::format("{}: its texture {} is missing; put the image there, or name one "
                    "with `texture`",
                    where, image.string()));
  }
  const std::string bytes = read_whole(image).value_or("");
  cv::Mat pixels = decode(bytes, fmt::format("{}: {}", where, image.string()));
  if (pixels.empty()) {
    throw DataError(fmt::format("{}: its texture {} is no image that OpenCV reads (PNG, JPEG, ...)",
                                where, image.string()));
  }
  note_orientation(bytes, image.string(), notes);
  return pixels;
}

cv::Mat load_texture(const mesh_wire::Scene& scene, const std::string& name,
                     const std::filesystem::path& mesh, std::vector<std::string>& notes) {
  if (!name.starts_with('*')) {
    std::string path = name;
    std::replace(path.begin(), path.end(), '\\', '/');  // exporters on Windows
    return read_texture(mesh.parent_path() / path, mesh.string(), notes);
  }
  std::size_t index = scene.textures.size();
  std::from_chars(name.data() + 1, name.data() + name.size(), index);
  if (index >= scene.textures.size()) {
    throw DataError(fmt::format("{}: it names texture {} of {} in the file", mesh.string(), name,
                                scene.textures.size()));
  }
  return decode_embedded(scene.textures[index], mesh.string(), notes);
}

}  // namespace hypotrack::internal
