#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "model/import/reader/gltf_file.hpp"

namespace hypotrack::mesh_wire {
inline namespace HYPOTRACK_EXPORTED internal {

/// The values of an accessor: `width` numbers each, one value after the other.
struct GltfValues {
  std::size_t width = 1;
  std::vector<double> numbers;

  std::size_t count() const { return numbers.size() / width; }
};

/// Reads an accessor by its type: floats, whole numbers, and normalised ones as numbers from -1 or
/// 0 to 1; strided or sparse (glTF 2.0, section 3.6.2). `widths` are the numbers per value that
/// `what` may have. Throws std::runtime_error, which begins with `what`.
GltfValues read_accessor(GltfFile& file, const Json& index, const std::vector<std::size_t>& widths,
                         const std::string& what);

}  // namespace internal
}  // namespace hypotrack::mesh_wire
