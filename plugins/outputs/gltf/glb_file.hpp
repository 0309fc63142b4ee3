#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

namespace hypotrack::gltf {

using Json = nlohmann::json;

/// What a buffer view is for; the values are OpenGL's.
enum class Use { other = 0, vertices = 34962, indices = 34963 };

/// A binary glTF 2.0 file that is put together in memory.
class GlbFile {
 public:
  /// Appends an object to one of glTF's lists, such as "nodes", and returns its index there.
  std::size_t add(const char* list, Json object);
  /// Returns an object of a list. The reference is valid until the next add().
  Json& at(const char* list, std::size_t index) { return json_[list][index]; }
  /// Returns the top level of the JSON.
  Json& json() { return json_; }

  /// Add an accessor of numbers, an element per column, and return its index. An accessor of
  /// `bounds` has the least and largest values, which positions and times must have.
  std::size_t add_floats(const Eigen::Ref<const Eigen::MatrixXf>& columns, Use use,
                         bool bounds = false);
  std::size_t add_indices(std::span<const std::uint32_t> indices);
  std::size_t add_joints(const Eigen::Ref<const Eigen::Matrix<std::uint16_t, 4, -1>>& joints);
  /// Adds bytes without an accessor, such as a picture's. Returns the index of their view.
  std::size_t add_bytes(const void* bytes, std::size_t count, Use use);

  /// Writes the file. Throws OutputError, also for more than 4 GiB, which the format cannot hold.
  void write(const std::filesystem::path& path);

 private:
  Json json_ = {{"asset", {{"version", "2.0"}, {"generator", "hypotrack"}}}};
  std::string binary_;
};

}  // namespace hypotrack::gltf
