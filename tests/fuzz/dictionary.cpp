#include "dictionary.hpp"

#include <fstream>
#include <stdexcept>

#include "target.hpp"

namespace hypotrack::fuzz {
namespace {

std::string unescaped(std::string_view text) {
  std::string token;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\\' && text.substr(i + 1).starts_with('x')) {
      token += static_cast<char>(std::stoi(std::string(text.substr(i + 2, 2)), nullptr, 16));
      i += 3;
    } else {
      if (text[i] == '\\') ++i;
      token += text.at(i);
    }
  }
  return token;
}

}  // namespace

std::vector<std::string> read_dictionary(std::string_view name) {
  const auto file = fuzz_folder() / "dictionaries" / (std::string(name) + ".dict");
  std::ifstream in(file);
  if (!in) throw std::runtime_error(file.string() + ": there is no such dictionary");
  std::vector<std::string> tokens;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line.starts_with('#')) continue;
    if (line.size() < 2 || line.front() != '"' || line.back() != '"')
      throw std::runtime_error(file.string() + ": expected a quoted token, found: " + line);
    tokens.push_back(unescaped(std::string_view(line).substr(1, line.size() - 2)));
  }
  return tokens;
}

}  // namespace hypotrack::fuzz
