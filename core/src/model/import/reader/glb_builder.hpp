#pragma once

#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>

#include "base/exported.hpp"
#include "model/import/reader/gltf_accessor.hpp"

namespace hypotrack::mesh_wire {
inline namespace HYPOTRACK_EXPORTED internal {

/// Types of numbers in accessors.
inline constexpr int kFloats = 5126, kWords = 5125, kShorts = 5123;

/// The binary part of a GLB file and the lists that tell what it holds.
class GlbBuilder {
 public:
  template <class Number>
  std::size_t add(const GltfValues& values, int component) {
    std::string bytes(values.numbers.size() * sizeof(Number), '\0');
    for (std::size_t i = 0; i < values.numbers.size(); ++i) {
      const auto number = static_cast<Number>(values.numbers[i]);
      std::memcpy(bytes.data() + i * sizeof(Number), &number, sizeof(Number));
    }
    return add_accessor({{"bufferView", add_view(bytes)},
                         {"componentType", component},
                         {"count", values.count()},
                         {"type", type_of(values.width)}});
  }
  std::size_t add_accessor(Json about);
  std::size_t add_view(std::string_view bytes);

  /// Returns a GLB file of this and of all else that `root` has.
  std::string finish(Json root) &&;

 private:
  static const char* type_of(std::size_t width);

  Json accessors_ = Json::array();
  Json views_ = Json::array();
  std::string binary_;
};

}  // namespace internal
}  // namespace hypotrack::mesh_wire
