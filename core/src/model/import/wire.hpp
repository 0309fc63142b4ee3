#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "base/exported.hpp"

// The data that the reader process sends to the program: plain data, field by field, in the
// machine's byte order. Both ends are the same build on the same machine.
namespace hypotrack::mesh_wire {
inline namespace HYPOTRACK_EXPORTED internal {

struct Weight {
  std::uint32_t bone;    ///< index into Scene::bones
  std::uint32_t vertex;  ///< index into the mesh
  float value;
};

struct MeshPart {
  std::string name;
  std::vector<std::array<float, 3>> positions;      ///< file frame, bind pose
  std::vector<std::array<float, 2>> uvs;            ///< one per vertex, v upwards; or empty
  std::vector<std::array<std::uint8_t, 3>> colors;  ///< RGB, one per vertex; or empty
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<Weight> weights;
  std::uint32_t material = 0;
};

struct BoneNode {
  std::string name;
  std::string parent;                       ///< nearest ancestor that is a bone; empty if none
  std::array<double, 16> file_from_bone{};  ///< row-major, with the file's scale
};

/// How a picture goes on outside [0, 1].
enum class Wrap : std::uint8_t { repeat, mirror, clamp };

struct Material {
  std::array<float, 3> color{};  ///< RGB as a screen shows it, of a surface without a picture
  std::string texture;           ///< path in the file, `*N` for embedded texture N, or empty
  std::string name;              ///< empty if the file gives none
  std::array<float, 3> factor{1, 1, 1};       ///< RGB, of light, on the picture
  std::array<Wrap, 2> wrap{};                 ///< along u and v
  std::array<float, 6> uv{1, 0, 0, 0, 1, 0};  ///< 2x3, row-major: what moves (u, v), v upwards
};

/// A texture embedded in the file: a compressed image, or `width` x `height` BGRA pixels.
struct Texture {
  std::uint32_t width = 0;  ///< 0 = compressed
  std::uint32_t height = 0;
  std::string bytes;
};

struct Scene {
  std::string error;  ///< why the file cannot be read; all else is then empty
  std::vector<MeshPart> meshes;
  std::vector<BoneNode> bones;
  std::vector<Material> materials;
  std::vector<Texture> textures;
  std::vector<std::string> notes;  ///< for the user: what the file has that is not read
  std::uint8_t linear_colors = 0;  ///< 1: colours between vertices are linear in light
};

inline constexpr std::string_view kMagic = "hypotrack mesh 4";

/// Appends values to a byte buffer.
class Writer {
 public:
  template <class T>
  void operator()(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof(T));
  }
  void operator()(const std::string& value) {
    (*this)(static_cast<std::uint64_t>(value.size()));
    bytes_ += value;
  }
  template <class T>
  void operator()(const std::vector<T>& values) {
    (*this)(static_cast<std::uint64_t>(values.size()));
    if constexpr (std::is_trivially_copyable_v<T>) {
      bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    } else {
      for (const T& value : values) fields(*this, value);
    }
  }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

/// Reads values back from a byte buffer. Throws std::runtime_error if the buffer ends too early.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}

  template <class T>
  void operator()(T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    std::memcpy(&value, take(sizeof(T)).data(), sizeof(T));
  }
  void operator()(std::string& value) { value = take(count(1)); }
  template <class T>
  void operator()(std::vector<T>& values) {
    if constexpr (std::is_trivially_copyable_v<T>) {
      values.resize(count(sizeof(T)));
      if (!values.empty()) {
        std::memcpy(values.data(), take(values.size() * sizeof(T)).data(),
                    values.size() * sizeof(T));
      }
    } else {
      values.resize(count(1));
      for (T& value : values) fields(*this, value);
    }
  }
  bool at_end() const { return bytes_.empty(); }

 private:
  std::string_view take(std::size_t size) {
    if (size > bytes_.size()) throw std::runtime_error("the answer ends too early");
    const std::string_view taken = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return taken;
  }
  std::size_t count(std::size_t item_size) {
    std::uint64_t items = 0;
    (*this)(items);
    if (items > bytes_.size() / item_size) throw std::runtime_error("the answer ends too early");
    return static_cast<std::size_t>(items);
  }
  std::string_view bytes_;
};

// One list of fields per struct serves writing and reading.
template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, std::string>
void fields(Archive& archive, T& text) { archive(text); }

template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, MeshPart>
void fields(Archive& archive, T& part) {
  archive(part.name);
  archive(part.positions);
  archive(part.uvs);
  archive(part.colors);
  archive(part.triangles);
  archive(part.weights);
  archive(part.material);
}

template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, BoneNode>
void fields(Archive& archive, T& bone) {
  archive(bone.name);
  archive(bone.parent);
  archive(bone.file_from_bone);
}

template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Material>
void fields(Archive& archive, T& material) {
  archive(material.color);
  archive(material.texture);
  archive(material.name);
  archive(material.factor);
  archive(material.wrap);
  archive(material.uv);
}

template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Texture>
void fields(Archive& archive, T& texture) {
  archive(texture.width);
  archive(texture.height);
  archive(texture.bytes);
}

template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Scene>
void fields(Archive& archive, T& scene) {
  archive(scene.error);
  archive(scene.meshes);
  archive(scene.bones);
  archive(scene.materials);
  archive(scene.textures);
  archive(scene.notes);
  archive(scene.linear_colors);
}

inline std::string encode(const Scene& scene) {
  Writer writer;
  writer(std::string(kMagic));
  fields(writer, scene);
  return writer.take();
}

/// Parses the bytes of encode(). Throws std::runtime_error on any others.
inline Scene decode(std::string_view bytes) {
  Reader reader(bytes);
  std::string magic;
  reader(magic);
  if (magic != kMagic) throw std::runtime_error("the answer is none");
  Scene scene;
  fields(reader, scene);
  if (!reader.at_end()) throw std::runtime_error("the answer is too long");
  return scene;
}

}  // namespace internal
}  // namespace hypotrack::mesh_wire
