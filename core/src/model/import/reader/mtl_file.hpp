#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/exported.hpp"
#include "model/import/wire.hpp"

namespace hypotrack::mesh_wire {
inline namespace HYPOTRACK_EXPORTED internal {

/// Begins texts of some programs on Windows.
inline constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// Takes the first word off a text.
std::string take_word(std::string_view& text);

/// A material of an MTL file.
struct MtlMaterial {
  std::optional<std::array<float, 3>> color;
  Material picture;                     // its texture, wrap and uv
  std::vector<std::string> left_out{};  // not drawn
};

/// Reads MTL files.
class MtlReader {
 public:
  std::map<std::string, MtlMaterial> materials;

  /// Reads the text of a file, whose name is for notes.
  void read(const std::string& text, const std::string& file, std::vector<std::string>& notes);
};

}  // namespace internal
}  // namespace hypotrack::mesh_wire
