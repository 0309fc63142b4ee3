#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/exported.hpp"
#include "model/import/reader/gltf_json.hpp"

namespace hypotrack::mesh_wire {
inline namespace HYPOTRACK_EXPORTED internal {

/// A glTF or GLB file: its JSON, and the bytes of its buffers.
class GltfFile {
 public:
  /// Throws std::runtime_error, as all members do.
  explicit GltfFile(const std::filesystem::path& file);

  const Json& root() const { return root_; }
  /// Returns the bytes of a buffer view, which live as long as this object.
  std::string_view view(const Json& index);
  /// Returns the bytes of an item of `images` that lies in the file: a buffer view or a data URI.
  std::string image(const Json& about);
  /// Returns the chunks of a GLB file that are neither JSON nor the binary buffer.
  const std::vector<std::string>& unknown_chunks() const { return unknown_chunks_; }

 private:
  void read_chunks();
  std::string_view buffer(std::size_t index);
  std::string load(const std::string& uri, const std::string& name) const;

  std::filesystem::path file_;
  std::string bytes_;
  Json root_;
  std::string_view binary_;  // the second chunk of a GLB file
  std::vector<std::optional<std::string>> buffers_;
  std::vector<std::string> unknown_chunks_;
};

}  // namespace internal
}  // namespace hypotrack::mesh_wire
