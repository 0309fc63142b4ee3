#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "hypotrack/api/files.hpp"
#include "hypotrack/api/text.hpp"
#include "model/import/reader/surfaces.hpp"
#include "model/import/srgb.hpp"
#include "model/import/wire.hpp"

namespace hypotrack::mesh_wire::internal {
namespace {

/// Begins texts of some programs on Windows.
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

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

constexpr std::string_view kSpaces = " \t\r\v\f";

/// Takes the first word off a text.
std::string take_word(std::string_view& text) {
  text = trimmed(text);
  const std::size_t end = std::min(text.find_first_of(kSpaces), text.size());
  const std::string word(text.substr(0, end));
  text = trimmed(text.substr(end));
  return word;
}

std::optional<float> number_of(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  float number = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(number)) return {};
  return number;
}

/// Takes up to three numbers off a text.
std::vector<float> take_numbers(std::string_view& text, std::size_t most = 3) {
  std::vector<float> numbers;
  while (numbers.size() < most) {
    std::string_view rest = text;
    const std::optional<float> number = number_of(take_word(rest));
    if (!number) break;
    numbers.push_back(*number);
    text = rest;
  }
  return numbers;
}

void take_picture(std::string_view rest, MtlMaterial& material) {
  Material& picture = material.picture;
  picture = {};
  while (rest.starts_with('-')) {
    const std::string option = take_word(rest);
    if (option == "-o" || option == "-s" || option == "-t") {
      const std::vector<float> numbers = take_numbers(rest);
      if (option == "-t") {
        material.left_out.push_back("map_Kd " + option);
        continue;
      }
      const std::array<std::size_t, 2> places =
          option == "-o" ? std::array<std::size_t, 2>{2, 5} : std::array<std::size_t, 2>{0, 4};
      for (std::size_t i = 0; i < 2 && i < numbers.size(); ++i) picture.uv[places[i]] = numbers[i];
    } else if (option == "-clamp") {
      if (take_word(rest) == "on") picture.wrap = {Wrap::clamp, Wrap::clamp};
    } else {
      if (option == "-mm") {
        take_numbers(rest, 2);
      } else {
        take_word(rest);
      }
      material.left_out.push_back("map_Kd " + option);
    }
  }
  picture.texture = rest;
}

void take_color(std::string_view rest, MtlMaterial& material) {
  const std::string all(rest);
  std::vector<float> numbers = take_numbers(rest);
  if (numbers.size() == 1) numbers.resize(3, numbers[0]);
  if (numbers.size() != 3) {
    material.left_out.push_back("Kd " + all);
    return;
  }
  material.color.emplace();
  for (std::size_t c = 0; c < 3; ++c) (*material.color)[c] = std::clamp(numbers[c], 0.0f, 1.0f);
}

void take(const std::string& key, std::string_view rest, int line, MtlMaterial& material) {
  const std::set<std::string, std::less<>> kOnlyShade = {
      "Ka", "Ks", "Ns", "Ni", "illum", "Tf",    "sharpness",
      "Pr", "Pm", "Ps", "Pc", "Pcr",   "aniso", "anisor"};
  if (kOnlyShade.contains(key)) return;
  std::vector<std::string>& left_out = material.left_out;
  if (key == "Kd") {
    take_color(rest, material);
  } else if (key == "map_Kd") {
    take_picture(rest, material);
  } else if (key == "d" || key == "Tr") {
    const std::vector<float> numbers = take_numbers(rest);
    if (numbers.empty()) {
      left_out.push_back(key + " " + std::string(rest));
    } else if (numbers[0] != (key == "d" ? 1 : 0)) {
      left_out.push_back(key + " (it is opaque)");
    }
  } else if (key == "Ke") {
    const std::vector<float> numbers = take_numbers(rest);
    if (std::ranges::any_of(numbers, [](float c) { return c != 0; }))
      left_out.push_back("Ke (it adds no light)");
  } else {
    left_out.push_back(key + " (line " + std::to_string(line) + ")");
  }
}

void MtlReader::read(const std::string& text, const std::string& file,
                     std::vector<std::string>& notes) {
  MtlMaterial* material = nullptr;
  std::istringstream in(text);
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    std::string_view rest = line;
    if (number == 1 && line.starts_with(kByteOrderMark)) rest.remove_prefix(kByteOrderMark.size());
    const std::string key = take_word(rest);
    if (key.starts_with('#')) continue;
    if (key.empty()) continue;
    if (key == "newmtl") {
      material = &(materials[std::string(rest)] = {});
    } else if (!material) {
      notes.push_back("its material file " + file + ", line " + std::to_string(number) + ": `" +
                      key + "` before the first `newmtl` is not read");
      return;
    } else {
      take(key, rest, number, *material);
    }
  }
}

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
