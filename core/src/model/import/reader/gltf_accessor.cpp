#include "model/import/reader/gltf_accessor.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <utility>

namespace hypotrack::mesh_wire::internal {
namespace {

constexpr std::uint64_t kMostNumbers = 48'000'000;  // of one accessor

enum class Component { i8 = 5120, u8 = 5121, i16 = 5122, u16 = 5123, u32 = 5125, f32 = 5126 };

/// How the numbers of a value lie in memory.
struct Layout {
  Component component = Component::f32;
  std::size_t width = 1;
  bool normalized = false;

  std::size_t number_size() const {
    switch (component) {
      case Component::i8:
      case Component::u8:
        return 1;
      case Component::i16:
      case Component::u16:
        return 2;
      default:
        return 4;
    }
  }
  std::size_t size() const { return width * number_size(); }
};

Component component_of(const Json& accessor) {
  const std::uint64_t type = whole(member(accessor, "componentType"), "componentType");
  for (const Component known : {Component::i8, Component::u8, Component::i16, Component::u16,
                                Component::u32, Component::f32})
    if (type == static_cast<std::uint64_t>(known)) return known;
  throw std::runtime_error("its numbers have the unknown type " + std::to_string(type));
}

std::size_t width_of(const Json& accessor) {
  constexpr std::array<std::pair<std::string_view, std::size_t>, 7> kWidths = {{{"SCALAR", 1},
                                                                                {"VEC2", 2},
                                                                                {"VEC3", 3},
                                                                                {"VEC4", 4},
                                                                                {"MAT2", 4},
                                                                                {"MAT3", 9},
                                                                                {"MAT4", 16}}};
  const std::string type = text(accessor, "type");
  for (const auto& [name, width] : kWidths)
    if (type == name) return width;
  throw std::runtime_error("its values have the unknown type '" + type + "'");
}

template <class Number>
double number_at(const char* at, bool normalized) {
  Number number;
  std::memcpy(&number, at, sizeof(number));
  const auto value = static_cast<double>(number);
  if (!normalized || !std::numeric_limits<Number>::is_integer) return value;
  return std::max(value / static_cast<double>(std::numeric_limits<Number>::max()), -1.0);
}

double number_at(const char* at, const Layout& layout) {
  switch (layout.component) {
    case Component::i8:
      return number_at<std::int8_t>(at, layout.normalized);
    case Component::u8:
      return number_at<std::uint8_t>(at, layout.normalized);
    case Component::i16:
      return number_at<std::int16_t>(at, layout.normalized);
    case Component::u16:
      return number_at<std::uint16_t>(at, layout.normalized);
    case Component::u32:
      return number_at<std::uint32_t>(at, layout.normalized);
    case Component::f32:
      break;
  }
  return number_at<float>(at, false);
}

/// Returns `count` values that lie `stride` bytes apart; 0: one after the other.
std::vector<double> read_values(std::string_view bytes, std::uint64_t offset, std::uint64_t stride,
                                std::uint64_t count, const Layout& layout) {
  const std::uint64_t size = layout.size();
  if (stride == 0) stride = size;
  if (stride < size) throw std::runtime_error("its values overlap");
  if (offset > bytes.size() || bytes.size() - offset < size ||
      (bytes.size() - offset - size) / stride < count - 1)
    throw std::runtime_error("its values reach beyond their buffer view");
  std::vector<double> numbers;
  numbers.reserve(static_cast<std::size_t>(count) * layout.width);
  for (std::uint64_t i = 0; i < count; ++i) {
    const char* const value = bytes.data() + offset + i * stride;
    for (std::size_t k = 0; k < layout.width; ++k)
      numbers.push_back(number_at(value + k * layout.number_size(), layout));
  }
  return numbers;
}

/// Replaces the values that a sparse accessor gives anew.
void replace_sparse(GltfFile& file, const Json& sparse, const Layout& layout,
                    std::vector<double>& numbers) {
  const std::uint64_t count = whole(member(sparse, "count"), "count");
  if (count == 0 || count > numbers.size() / layout.width)
    throw std::runtime_error("it replaces " + std::to_string(count) + " of its values");
  const Json& where = member(sparse, "indices");
  const Json& values = member(sparse, "values");
  const std::vector<double> places =
      read_values(file.view(member(where, "bufferView")), whole(where, "byteOffset", 0), 0, count,
                  {component_of(where), 1, false});
  const std::vector<double> replaced = read_values(
      file.view(member(values, "bufferView")), whole(values, "byteOffset", 0), 0, count, layout);
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!(places[i] >= 0 && places[i] < static_cast<double>(numbers.size() / layout.width)))
      throw std::runtime_error("it replaces values that it does not have");
    const std::size_t first = static_cast<std::size_t>(places[i]) * layout.width;
    std::copy_n(replaced.begin() + static_cast<std::ptrdiff_t>(i * layout.width), layout.width,
                numbers.begin() + static_cast<std::ptrdiff_t>(first));
  }
}

GltfValues values_of(GltfFile& file, const Json& accessor, const std::vector<std::size_t>& widths) {
  const Json& normalized = member(accessor, "normalized");
  const Layout layout{component_of(accessor), width_of(accessor),
                      normalized.is_boolean() && normalized.get<bool>()};
  if (std::ranges::find(widths, layout.width) == widths.end())
    throw std::runtime_error("its values have the type " + text(accessor, "type"));
  const std::uint64_t count = whole(member(accessor, "count"), "count");
  if (count == 0) throw std::runtime_error("there are none");
  if (count > kMostNumbers / layout.width)
    throw std::runtime_error("there are " + std::to_string(count) + ": decimate the mesh");
  GltfValues values{layout.width, {}};
  if (const Json& view = member(accessor, "bufferView"); view.is_null()) {
    values.numbers.resize(static_cast<std::size_t>(count) * layout.width);  // zeros, says glTF
  } else {
    values.numbers =
        read_values(file.view(view), whole(accessor, "byteOffset", 0),
                    whole(item(file.root(), "bufferViews", view), "byteStride", 0), count, layout);
  }
  if (const Json& sparse = member(accessor, "sparse"); !sparse.is_null())
    replace_sparse(file, sparse, layout, values.numbers);
  return values;
}

}  // namespace

GltfValues read_accessor(GltfFile& file, const Json& index, const std::vector<std::size_t>& widths,
                         const std::string& what) {
  try {
    return values_of(file, item(file.root(), "accessors", index), widths);
  } catch (const std::runtime_error& error) {
    const std::string name = index.is_number_unsigned() ? " (accessor " + index.dump() + ")" : "";
    throw std::runtime_error(what + name + ": " + error.what());
  }
}

}  // namespace hypotrack::mesh_wire::internal
