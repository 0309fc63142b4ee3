#include "model/import/texture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "hypotrack/error.hpp"
#include "hypotrack/media.hpp"

namespace hypotrack {
namespace {

cv::Mat decode_embedded(const mesh_wire::Texture& texture, const std::string& where) {
  cv::Mat image;
  try {
    if (texture.width > 0) {
      const std::size_t size = std::size_t{4} * texture.width * texture.height;
      if (texture.bytes.size() == size && texture.width < 1 << 16 && texture.height < 1 << 16) {
        const cv::Mat pixels(static_cast<int>(texture.height), static_cast<int>(texture.width),
                             CV_8UC4, const_cast<char*>(texture.bytes.data()));
        cv::cvtColor(pixels, image, cv::COLOR_BGRA2BGR);
      }
    } else if (!texture.bytes.empty()) {
      const cv::Mat bytes(1, static_cast<int>(texture.bytes.size()), CV_8UC1,
                          const_cast<char*>(texture.bytes.data()));
      image = decode_image(bytes, cv::IMREAD_COLOR);
    }
  } catch (const cv::Exception&) {
    image.release();
  }
  if (image.empty()) {
    throw DataError(where +
                    ": the texture inside the mesh file is damaged or of a format that "
                    "OpenCV does not read; `texture` can name another image");
  }
  return image;
}

}  // namespace

cv::Mat read_texture(const std::filesystem::path& image, const std::string& where) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(image, error)) {
    throw DataError(
        fmt::format("{}: its texture {} is missing; put the image there, or name one "
                    "with `texture`",
                    where, image.string()));
  }
  cv::Mat pixels;
  try {
    pixels = read_image(image.string(), cv::IMREAD_COLOR);
  } catch (const cv::Exception&) {
    pixels.release();
  }
  if (pixels.empty()) {
    throw DataError(fmt::format("{}: its texture {} is no image that OpenCV reads (PNG, JPEG, ...)",
                                where, image.string()));
  }
  return pixels;
}

cv::Mat load_texture(const mesh_wire::Scene& scene, const std::string& name,
                     const std::filesystem::path& mesh) {
  if (!name.starts_with('*')) {
    std::string path = name;
    std::replace(path.begin(), path.end(), '\\', '/');  // exporters on Windows
    return read_texture(mesh.parent_path() / path, mesh.string());
  }
  std::size_t index = scene.textures.size();
  std::from_chars(name.data() + 1, name.data() + name.size(), index);
  if (index >= scene.textures.size()) {
    throw DataError(fmt::format("{}: it names texture {} of {} in the file", mesh.string(), name,
                                scene.textures.size()));
  }
  return decode_embedded(scene.textures[index], mesh.string());
}

}  // namespace hypotrack
