#include "model/import/format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>

#include "hypotrack/api/error.hpp"
#include "model/import/ply_header.hpp"

namespace hypotrack::internal {
namespace {

constexpr std::uintmax_t kLargestFile = std::uintmax_t{256} << 20;
constexpr std::string_view kFormats = "DAE, OBJ, PLY, STL, glTF (.gltf) and GLB";

struct FileHead {
  std::string name;
  std::uintmax_t size = 0;
  std::string head;  ///< the first bytes
};

[[noreturn]] void fail(const FileHead& file, const std::string& what) {
  throw DataError(file.name + ": " + what);
}

std::uint32_t little_endian(const FileHead& file, std::size_t offset) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) {
    value = value << 8 | static_cast<unsigned char>(file.head.at(offset + i));
  }
  return value;
}

bool is_text(const FileHead& file) { return file.head.find('\0') == std::string::npos; }

using Notes = std::vector<std::string>;

/// Fails if a function finds something wrong with a text file's lines.
void check_text(const FileHead& file, std::string_view format, Notes& notes,
                std::string (*problem_of)(std::istream&, Notes&)) {
  std::ifstream in(file.name, std::ios::binary);
  const std::string problem = problem_of(in, notes);
  if (problem.empty()) return;
  fail(file, fmt::format("the {} file is damaged: {}; copy or export it again", format, problem));
}

void check_glb(const FileHead& file, Notes&) {
  if (file.size < 20 || !file.head.starts_with("glTF")) {
    fail(file, "this is no GLB file: it does not begin with 'glTF'");
  }
  if (const auto version = little_endian(file, 4); version != 2) {
    fail(file, fmt::format("this is GLB version {}; hypotrack reads version 2", version));
  }
  if (const auto length = little_endian(file, 8); length != file.size) {
    fail(file, fmt::format("the GLB file is damaged: its header says {} bytes, it has {}; copy or "
                           "export it again",
                           length, file.size));
  }
}

void check_gltf(const FileHead& file, Notes&) {
  const std::size_t first = file.head.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (first == std::string::npos || file.head[first] != '{' || !is_text(file)) {
    fail(file, "this is no glTF file: it does not begin with a JSON object");
  }
}

/// Tells of the attributes of a binary STL file that are not read.
void note_stl_attributes(const FileHead& file, std::uint64_t triangles, Notes& notes) {
  constexpr std::size_t kHeader = 84, kTriangle = 50;
  // Colours are read where the highest bit says that there is one, as VisCAM writes them.
  const bool magics = file.head.substr(0, 80).find("COLOR=") != std::string::npos;
  std::ifstream in(file.name, std::ios::binary);
  in.seekg(kHeader);
  std::uint64_t unread = 0;
  std::array<char, kTriangle> bytes;
  for (std::uint64_t i = 0; i < triangles && in.read(bytes.data(), kTriangle); ++i) {
    const auto low = static_cast<unsigned char>(bytes[48]);
    const auto high = static_cast<unsigned char>(bytes[49]);
    const bool has_flag = (high & 0x80) != 0, has_value = low != 0 || (high & 0x7f) != 0;
    unread += (magics ? has_flag != has_value : !has_flag && has_value) ? 1 : 0;
  }
  if (unread > 0)
    notes.push_back(fmt::format(
        "the attributes of {} facets are not read{}: export PLY, OBJ or GLB if they are colours",
        unread, magics ? ", which have colours as Materialise Magics writes them" : ""));
}

void check_stl(const FileHead& file, Notes& notes) {
  const std::size_t first = file.head.find_first_not_of(" \t\r\n");
  const bool solid = first != std::string::npos && file.head.substr(first).starts_with("solid");
  if (solid && is_text(file)) return check_text(file, "STL", notes, problem_of_text_stl);
  if (first != std::string::npos && file.head.substr(first).starts_with("SOLID") && is_text(file))
    fail(file, "this STL file is text in capital letters; write its words in small letters");
  if (file.size < 84) fail(file, "this is no STL file: it is too short for the binary header");
  const std::uint64_t triangles = little_endian(file, 80);
  if (file.size != 84 + 50 * triangles) {  // the importer takes no others for binary
    fail(file, fmt::format("the STL file is damaged or none: its header says {} triangles, which "
                           "take {} bytes; it has {}",
                           triangles, 84 + 50 * triangles, file.size));
  }
  note_stl_attributes(file, triangles, notes);
}

void check_obj(const FileHead& file, Notes& notes) {
  if (!is_text(file)) fail(file, "this is no OBJ file: it is not text");
  for (const std::string_view other : {"ply\n", "ply\r", "solid ", "glTF"}) {
    if (file.head.starts_with(other)) {
      fail(file, fmt::format("this is no OBJ file: it begins with '{}'", other.substr(0, 3)));
    }
  }
  check_text(file, "OBJ", notes, problem_of_obj);
}

void check_ply(const FileHead& file, Notes& notes) {
  std::ifstream in(file.name, std::ios::binary);
  const PlyHeader header = read_ply_header(in);
  if (!header.unread.empty())
    notes.push_back("elements and properties that are not read: " + header.unread);
  if (!header.problem.empty()) fail(file, "this is no PLY file: " + header.problem);
  if (header.has_strips)
    fail(file,
         "its triangles are in strips (element tristrips), which are not read; save it with faces, "
         "for example with MeshLab");
  std::uint64_t found = 0;
  std::string line;
  if (header.is_text) {
    while (std::getline(in, line)) found += line.find_first_not_of(" \t\r") != std::string::npos;
  } else {
    found = in.eof() ? 0 : file.size - static_cast<std::uint64_t>(in.tellg());
  }
  if (const auto least = header.is_text ? header.count : header.least; found < least) {
    fail(file, fmt::format("the PLY file is damaged: its header says {}, which take {} {} at "
                           "least, and {} follow; copy or export it again",
                           header.elements, least, header.is_text ? "lines" : "bytes", found));
  }
}

void check_dae(const FileHead& file, Notes&) {
  if (!is_text(file)) fail(file, "this is no DAE file: it is not text in UTF-8");
  if (file.head.find("<COLLADA") != std::string::npos) return;
  const std::size_t first = file.head.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (first == std::string::npos || file.head[first] != '<' || file.size <= file.head.size())
    fail(file, "this is no DAE file: it has no <COLLADA> element");
}

FileHead open(const std::filesystem::path& path) {
  FileHead file;
  file.name = path.string();
  std::error_code error;
  if (!std::filesystem::exists(path, error)) fail(file, "there is no such mesh file");
  if (!std::filesystem::is_regular_file(path, error)) fail(file, "the mesh is not a file");
  file.size = std::filesystem::file_size(path, error);
  if (error) fail(file, "the mesh file cannot be read: " + error.message());
  std::ifstream stream(path, std::ios::binary);
  std::array<char, 1024> head;
  stream.read(head.data(), head.size());
  if (stream.bad() || !stream.is_open()) {
    fail(file, fmt::format("the mesh file cannot be read: {}", std::strerror(errno)));
  }
  file.head.assign(head.data(), static_cast<std::size_t>(stream.gcount()));
  return file;
}

}  // namespace

std::vector<std::string> check_mesh_format(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  using Check = void (*)(const FileHead&, Notes&);
  Check check = extension == ".obj"    ? check_obj
                : extension == ".ply"  ? check_ply
                : extension == ".stl"  ? check_stl
                : extension == ".dae"  ? check_dae
                : extension == ".gltf" ? check_gltf
                : extension == ".glb"  ? check_glb
                                       : nullptr;
  if (!check) {
    throw DataError(
        fmt::format("{}: hypotrack does not read meshes of type '{}'; it reads {}: "
                    "convert the file (Blender exports glTF)",
                    path.string(), extension.empty() ? "(no extension)" : extension, kFormats));
  }
  const FileHead file = open(path);
  if (file.size == 0) fail(file, "the mesh file is empty");
  if (file.size > kLargestFile) {
    fail(file, fmt::format("the mesh file has {} MiB; at most {} MiB are read: decimate the mesh",
                           file.size >> 20, kLargestFile >> 20));
  }
  Notes notes;
  check(file, notes);
  return notes;
}

}  // namespace hypotrack::internal
