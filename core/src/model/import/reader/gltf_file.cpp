#include "model/import/reader/gltf_file.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <stdexcept>

#include "hypotrack/api/files.hpp"

namespace hypotrack::mesh_wire::internal {
namespace {

constexpr std::uintmax_t kLargestBuffer = std::uintmax_t{256} << 20;

std::uint32_t word_at(const std::string& bytes, std::size_t offset) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + offset, sizeof(value));
  return value;
}

int value_of_hex(char digit) {
  if (digit >= '0' && digit <= '9') return digit - '0';
  if (digit >= 'a' && digit <= 'f') return digit - 'a' + 10;
  return digit >= 'A' && digit <= 'F' ? digit - 'A' + 10 : -1;
}

/// Decodes the characters of a URI that are written as `%20`.
std::string decode_percent(const std::string& uri) {
  std::string path;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const int high = uri[i] == '%' && i + 2 < uri.size() ? value_of_hex(uri[i + 1]) : -1;
    const int low = high >= 0 ? value_of_hex(uri[i + 2]) : -1;
    path += low >= 0 ? static_cast<char>(16 * high + low) : uri[i];
    if (low >= 0) i += 2;
  }
  return path;
}

int value_of_base64(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' || c == '-' ? 62 : c == '/' || c == '_' ? 63 : -1;
}

std::string decode_base64(std::string_view text, const std::string& name) {
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text.substr(0, text.find('='))) {
    const int value = value_of_base64(c);
    if (value < 0) throw std::runtime_error(name + " is no base64 text");
    bits = bits << 6 | static_cast<std::uint32_t>(value);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 0xff);
  }
  return bytes;
}

}  // namespace

GltfFile::GltfFile(const std::filesystem::path& file) : file_(file) {
  bytes_ = read_whole(file).value_or("");
  if (bytes_.starts_with("glTF")) {
    read_chunks();
  } else {
    root_ = parse_gltf(bytes_.data(), bytes_.data() + bytes_.size());
  }
  buffers_.resize(list(root_, "buffers").size());
}

void GltfFile::read_chunks() {
  constexpr std::size_t kHeader = 12, kChunkHeader = 8;
  constexpr std::string_view kJson = "JSON", kBinary{"BIN\0", 4};
  for (std::size_t at = kHeader, chunk = 0; at < bytes_.size(); ++chunk) {
    if (bytes_.size() - at < kChunkHeader)
      throw std::runtime_error("the GLB file ends within its header");
    const std::size_t length = word_at(bytes_, at);
    const std::string type = bytes_.substr(at + 4, 4);
    at += kChunkHeader;
    if (length > bytes_.size() - at)
      throw std::runtime_error(chunk == 0 ? "the GLB file ends within its JSON"
                                          : "the GLB file ends within its data");
    if ((type == kJson) != (chunk == 0))
      throw std::runtime_error(
          "the first chunk of the GLB file is not its JSON, or a later one is");
    if (chunk == 0) {
      root_ = parse_gltf(bytes_.data() + at, bytes_.data() + at + length);
    } else if (chunk == 1 && type == kBinary) {
      binary_ = std::string_view(bytes_).substr(at, length);
    } else {
      unknown_chunks_.push_back(type);
    }
    at += std::min((length + 3) / 4 * 4, bytes_.size() - at);
  }
  if (!root_.is_object()) throw std::runtime_error("the GLB file ends within its header");
}

std::string GltfFile::load(const std::string& uri, const std::string& name) const {
  constexpr std::string_view kData = "data:", kBase64 = ";base64,";
  if (uri.starts_with(kData)) {
    const std::size_t begin = uri.find(kBase64);
    if (begin == uri.npos) throw std::runtime_error(name + " is a data URI that is not base64");
    return decode_base64(std::string_view(uri).substr(begin + kBase64.size()), name);
  }
  const std::filesystem::path path = file_.parent_path() / decode_percent(uri);
  const std::string whole_name = name + ", the file '" + uri + "',";
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error))
    throw std::runtime_error(whole_name +
                             " is missing or no file; copy it beside the glTF file, or export a "
                             "GLB file, which has all in one");
  if (std::filesystem::file_size(path, error) > kLargestBuffer || error)
    throw std::runtime_error(whole_name + " has more than 256 MiB: decimate the mesh");
  std::optional<std::string> bytes = read_whole(path);
  if (!bytes) throw std::runtime_error(whole_name + " cannot be read");
  return *std::move(bytes);
}

std::string_view GltfFile::buffer(std::size_t index) {
  const Json& about = list(root_, "buffers")[index];
  const std::string name = "buffer " + std::to_string(index);
  std::string_view bytes = binary_;
  if (const Json& uri = member(about, "uri"); !uri.is_null()) {
    if (!uri.is_string()) throw std::runtime_error("the uri of " + name + " is no text");
    if (!buffers_[index]) buffers_[index] = load(uri.get<std::string>(), name);
    bytes = *buffers_[index];
  } else if (index != 0 || binary_.data() == nullptr) {
    throw std::runtime_error(name +
                             " has no data: neither a uri nor the binary part of a GLB file");
  }
  const std::uint64_t length = whole(member(about, "byteLength"), "byteLength");
  if (length > bytes.size())
    throw std::runtime_error(name + " has " + std::to_string(bytes.size()) + " bytes, expected " +
                             std::to_string(length) + "; copy or export the file again");
  return bytes.substr(0, static_cast<std::size_t>(length));
}

std::string_view GltfFile::view(const Json& index) {
  const Json& about = item(root_, "bufferViews", index);
  item(root_, "buffers", member(about, "buffer"));
  const std::string_view bytes =
      buffer(static_cast<std::size_t>(whole(member(about, "buffer"), "buffer")));
  const std::uint64_t offset = whole(about, "byteOffset", 0);
  const std::uint64_t length = whole(member(about, "byteLength"), "byteLength");
  if (offset > bytes.size() || length > bytes.size() - offset)
    throw std::runtime_error("buffer view " + index.dump() + " reads beyond its buffer");
  return bytes.substr(static_cast<std::size_t>(offset), static_cast<std::size_t>(length));
}

std::string GltfFile::image(const Json& about) {
  if (const Json& index = member(about, "bufferView"); !index.is_null())
    return std::string(view(index));
  const std::string uri = text(about, "uri");
  if (uri.empty()) throw std::runtime_error("an image has neither a bufferView nor a uri");
  return load(uri, "an image");
}

}  // namespace hypotrack::mesh_wire::internal
