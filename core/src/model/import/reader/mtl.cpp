#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <string_view>

#include "hypotrack/api/files.hpp"
#include "hypotrack/api/text.hpp"
#include "model/import/reader/mtl_file.hpp"
#include "model/import/reader/surfaces.hpp"
#include "model/import/srgb.hpp"

namespace hypotrack::mesh_wire::internal {
namespace {

constexpr std::uintmax_t kLargestFile = std::uintmax_t{16} << 20;

/// The libraries and materials that an OBJ file names.
struct Named {
  std::vector<std::string> libraries;
  std::map<std::string, int> used;  ///< materials, and the first lines that use them
};

Named named_by(const std::string& obj) {
  Named out;
  std::ifstream in(obj, std::ios::binary);
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (number == 1 && line.starts_with(kByteOrderMark)) line.erase(0, kByteOrderMark.size());
    std::string_view rest = line;
    if (!trimmed(rest).starts_with("usemtl") && !trimmed(rest).starts_with("mtllib")) continue;
    const std::string key = take_word(rest);
    if (key == "mtllib") out.libraries.emplace_back(rest);
    if (key == "usemtl") out.used.emplace(rest, number);
  }
  return out;
}

/// Reads the libraries of an OBJ file. A missing one has a note; one of the file's own name takes
/// its place, as importers do.
class Libraries {
 public:
  Libraries(const std::string& obj, MtlReader& reader, std::vector<std::string>& notes)
      : obj_(obj), reader_(reader), notes_(notes) {}

  void read(const std::string& names) {
    if (read_file(names)) return;
    std::string_view rest = names;
    std::vector<std::string> words;
    while (!rest.empty()) words.push_back(take_word(rest));
    for (const std::string& word : words) {
      if (words.size() > 1 && read_file(word)) continue;
      const std::string own = obj_.stem().string() + ".mtl";
      const bool replaced = word != own && read_file(own);
      notes_.push_back("its material file " + (words.size() > 1 ? word : names) +
                       " is missing or too large: " +
                       (replaced ? own + " is read instead" : "put it beside the mesh"));
      some_missing = some_missing || !replaced;
    }
  }

  bool some_missing = false;
  std::string read_files;  // for messages

 private:
  bool read_file(std::string name) {
    std::replace(name.begin(), name.end(), '\\', '/');  // exporters on Windows
    const std::filesystem::path path = obj_.parent_path() / name;
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) return false;
    if (std::filesystem::file_size(path, error) > kLargestFile || error) return false;
    const std::optional<std::string> text = read_whole(path);
    if (!text) return false;
    reader_.read(*text, name, notes_);
    read_files += (read_files.empty() ? "" : ", ") + name;
    return true;
  }

  std::filesystem::path obj_;
  MtlReader& reader_;
  std::vector<std::string>& notes_;
};

/// Sets what assimp reads differently, or not at all.
void convert(const MtlMaterial& from, Material& to, std::vector<std::string>& left_out) {
  to.texture = from.picture.texture;
  to.wrap = from.picture.wrap;
  to.uv = from.picture.uv;
  if (!from.color) return;
  to.color = *from.color;
  if (to.texture.empty()) return;
  if (*from.color == std::array<float, 3>{0, 0, 0}) {
    left_out.push_back("Kd 0 0 0 (it would make map_Kd black)");
    return;
  }
  for (std::size_t c = 0; c < 3; ++c) to.factor[c] = srgb::linear((*from.color)[c]);
}

}  // namespace

void convert_mtl_materials(const std::string& obj, Scene& out) {
  const Named named = named_by(obj);
  MtlReader reader;
  Libraries libraries(obj, reader, out.notes);
  for (const std::string& names : named.libraries) libraries.read(names);
  for (Material& material : out.materials) {
    const auto found = reader.materials.find(material.name);
    if (found == reader.materials.end()) continue;
    std::vector<std::string> left_out = found->second.left_out;
    convert(found->second, material, left_out);
    if (named.used.contains(material.name)) add_note(material, left_out, out);
  }
  std::string undefined;
  for (const auto& [name, line] : named.used)
    if (!reader.materials.contains(name))
      undefined +=
          (undefined.empty() ? "'" : ", '") + name + "' (line " + std::to_string(line) + ")";
  if (undefined.empty() || libraries.some_missing) return;
  out.notes.push_back(
      "the materials " + undefined + " are not defined in " +
      (libraries.read_files.empty() ? "a material file (`mtllib`)" : libraries.read_files) +
      ": their surfaces are grey");
}

}  // namespace hypotrack::mesh_wire::internal
