#include "config/yaml_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <fstream>
#include <system_error>
#include <utility>

#include "config/yaml_reader.hpp"
#include "hypotrack/error.hpp"

namespace hypotrack::detail {
namespace {

std::string read_file(const std::filesystem::path& file) {
  if (file.empty()) throw ConfigError("the name of the file is empty; expected a YAML file");
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) {
    throw ConfigError(file.string() + ": is a folder; expected a YAML file");
  }
  std::ifstream in(file, std::ios::binary);
  if (!in) {
    throw ConfigError(fmt::format("{}: cannot be opened: {}", file.string(),
                                  std::generic_category().message(errno)));
  }
  // One byte above the limit is enough to detect a file that is too large.
  std::string text(kMaxYamlBytes + 4, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (in.bad()) throw ConfigError(file.string() + ": cannot be read");
  return text;
}

}  // namespace

std::unique_ptr<YamlNode> read_document(std::string_view text, std::string name,
                                        const std::filesystem::path& directory) {
  auto origin = std::make_shared<YamlOrigin>();
  origin->name = std::move(name);
  origin->directory =
      std::filesystem::absolute(directory.empty() ? std::filesystem::current_path() : directory);
  auto root = read_yaml(text, origin);
  if (root->kind == YamlNode::Kind::kNull) root->kind = YamlNode::Kind::kMap;
  return root;
}

std::unique_ptr<YamlNode> read_yaml_file(const std::filesystem::path& file) {
  const std::string text = read_file(file);
  return read_document(text, file.string(), std::filesystem::absolute(file).parent_path());
}

}  // namespace hypotrack::detail
