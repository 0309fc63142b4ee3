#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace hypotrack::test {

using Json = nlohmann::json;

/// Types of numbers in glTF.
constexpr int kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123,
              kUnsignedInt = 5125, kFloat = 5126;

/// Makes a GLB file of accessors and JSON.
class GlbWriter {
 public:
  template <class T>
  int add(const std::vector<T>& values, const char* type, int component_type,
          bool normalized = false) {
    const int view = add_view(values.data(), values.size() * sizeof(T));
    json_["accessors"].push_back({{"bufferView", view},
                                  {"componentType", component_type},
                                  {"count", values.size()},
                                  {"type", type}});
    if (normalized) json_["accessors"].back()["normalized"] = true;
    return static_cast<int>(json_["accessors"].size()) - 1;
  }

  int add_view(const void* data, std::size_t size) {
    while (binary_.size() % 4 != 0) binary_ += '\0';
    json_["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", size}});
    binary_.append(static_cast<const char*>(data), size);
    return static_cast<int>(json_["bufferViews"].size()) - 1;
  }

  Json& json() { return json_; }
  const Json& json() const { return json_; }

  /// Returns the binary data so far.
  const std::string& binary() const { return binary_; }

  /// Returns the file. `chunk`, if given, is the type of an empty chunk at its end.
  std::string finish(const std::string& chunk = "") const {
    Json json = json_;
    json["asset"]["version"] = "2.0";
    const std::string binary = padded(binary_, '\0');
    json["buffers"] = {{{"byteLength", binary.size()}}};
    const std::string text = padded(json.dump(), ' ');
    std::string chunks;
    append(chunks, text.size());
    chunks += "JSON" + text;
    append(chunks, binary.size());
    chunks += std::string("BIN\0", 4) + binary;
    if (!chunk.empty()) append(chunks, 0);
    chunks += chunk;
    std::string file = "glTF";
    append(file, 2);
    append(file, 12 + chunks.size());
    return file + chunks;
  }

 private:
  static std::string padded(std::string bytes, char with) {
    bytes.resize((bytes.size() + 3) / 4 * 4, with);
    return bytes;
  }
  static void append(std::string& file, std::size_t value) {
    const auto word = static_cast<std::uint32_t>(value);
    file.append(reinterpret_cast<const char*>(&word), sizeof(word));
  }
  Json json_;
  std::string binary_;
};

}  // namespace hypotrack::test
