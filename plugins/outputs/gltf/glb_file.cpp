#include "glb_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>
#include <utility>

#include "hypotrack/api/error.hpp"

namespace hypotrack::gltf {
namespace {

/// Component types of glTF 2.0; the values are OpenGL's.
enum class Component { uint16 = 5123, uint32 = 5125, float32 = 5126 };

const char* type_of(Eigen::Index rows) {
  switch (rows) {
    case 1:
      return "SCALAR";
    case 2:
      return "VEC2";
    case 3:
      return "VEC3";
    case 4:
      return "VEC4";
    default:
      return "MAT4";
  }
}

Json numbers(const Eigen::VectorXf& values) {
  return std::vector<float>(values.data(), values.data() + values.size());
}

/// Appends an unsigned number of 32 bits, lowest byte first.
void append(std::string& bytes, std::uint64_t number) {
  for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(number >> shift & 0xff);
}

/// Appends what makes the length a multiple of four.
void pad(std::string& bytes, char filler) { bytes.resize((bytes.size() + 3) / 4 * 4, filler); }

}  // namespace

std::size_t GlbFile::add(const char* list, Json object) {
  json_[list].push_back(std::move(object));
  return json_[list].size() - 1;
}

std::size_t GlbFile::add_bytes(const void* bytes, std::size_t count, Use use) {
  pad(binary_, '\0');
  Json view = {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", count}};
  if (use != Use::other) view["target"] = static_cast<int>(use);
  binary_.append(static_cast<const char*>(bytes), count);
  return add("bufferViews", std::move(view));
}

std::size_t GlbFile::add_floats(const Eigen::Ref<const Eigen::MatrixXf>& columns, Use use,
                                bool bounds) {
  const Eigen::MatrixXf packed = columns;
  const auto bytes = static_cast<std::size_t>(packed.size()) * sizeof(float);
  Json accessor = {{"bufferView", add_bytes(packed.data(), bytes, use)},
                   {"componentType", static_cast<int>(Component::float32)},
                   {"count", packed.cols()},
                   {"type", type_of(packed.rows())}};
  if (bounds) {
    accessor["min"] = numbers(packed.rowwise().minCoeff());
    accessor["max"] = numbers(packed.rowwise().maxCoeff());
  }
  return add("accessors", std::move(accessor));
}

std::size_t GlbFile::add_indices(std::span<const std::uint32_t> indices) {
  return add("accessors",
             {{"bufferView", add_bytes(indices.data(), indices.size_bytes(), Use::indices)},
              {"componentType", static_cast<int>(Component::uint32)},
              {"count", indices.size()},
              {"type", "SCALAR"}});
}

std::size_t GlbFile::add_joints(
    const Eigen::Ref<const Eigen::Matrix<std::uint16_t, 4, -1>>& joints) {
  const auto bytes = static_cast<std::size_t>(joints.size()) * sizeof(std::uint16_t);
  return add("accessors", {{"bufferView", add_bytes(joints.data(), bytes, Use::vertices)},
                           {"componentType", static_cast<int>(Component::uint16)},
                           {"count", joints.cols()},
                           {"type", "VEC4"}});
}

void GlbFile::write(const std::filesystem::path& path) {
  constexpr std::uint64_t kVersion = 2, kHeader = 12, kChunkHeader = 8;
  pad(binary_, '\0');
  json_["buffers"] = {{{"byteLength", binary_.size()}}};
  std::string text = json_.dump(-1, ' ', false, Json::error_handler_t::replace);
  pad(text, ' ');
  const std::uint64_t length = kHeader + 2 * kChunkHeader + text.size() + binary_.size();
  if (length > std::numeric_limits<std::uint32_t>::max())
    throw OutputError(
        fmt::format("{}: {} bytes of motion are more than a .glb file can hold (4 GiB); track the "
                    "recording in parts",
                    path.string(), length));
  std::string head = "glTF";
  append(head, kVersion);
  append(head, length);
  append(head, text.size());
  head += "JSON" + text;
  append(head, binary_.size());
  head += std::string("BIN\0", 4);
  std::ofstream out(path, std::ios::binary);
  errno = 0;
  out << head << binary_;
  out.close();
  if (!out)
    throw OutputError(
        fmt::format("{}: cannot be written: {}; make room or name another folder with --out",
                    path.string(), errno != 0 ? std::strerror(errno) : "unknown reason"));
}

}  // namespace hypotrack::gltf
