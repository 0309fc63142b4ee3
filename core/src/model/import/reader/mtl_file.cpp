#include "model/import/reader/mtl_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <sstream>

#include "hypotrack/api/text.hpp"

namespace hypotrack::mesh_wire::internal {
namespace {

constexpr std::string_view kSpaces = " \t\r\v\f";

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

}  // namespace

/// Takes the first word off a text.
std::string take_word(std::string_view& text) {
  text = trimmed(text);
  const std::size_t end = std::min(text.find_first_of(kSpaces), text.size());
  const std::string word(text.substr(0, end));
  text = trimmed(text.substr(end));
  return word;
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

}  // namespace hypotrack::mesh_wire::internal
