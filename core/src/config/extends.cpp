#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>
#include <vector>

#include "config/file_name.hpp"
#include "config/includes.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack::detail::internal {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostExtended = 16;

bool is_map(const YamlNode& node) { return node.kind == YamlNode::Kind::kMap; }

/// Adds the entries of `more` to `map`, or puts them in the place of what it has.
void add_to(YamlNode& map, YamlNode& more) {
  for (YamlNode::Entry& entry : more.entries) {
    YamlNode::Entry* const there = map.find(entry.key);
    entry.value->parent = &map;
    if (!there)
      map.entries.push_back(std::move(entry));
    else if (is_map(*there->value) && is_map(*entry.value) && !entry.value->find("type"))
      add_to(*there->value, *entry.value);
    else
      *there = std::move(entry);
  }
}

FileName name_of_base(const YamlNode& value) {
  if (auto name = file_name_in(value)) return *std::move(name);
  throw ConfigError(
      fmt::format("{}: extends: expected a study, \"@studies/NAME\" or \"@FILE.yaml\"",
                  describe_position(*value.origin, value.line, value.column)));
}

std::unique_ptr<YamlNode> read(const fs::path& file, std::vector<fs::path>& readers) {
  auto root = read_yaml_file(file);
  YamlNode::Entry* const extends = root->find("extends");
  if (!extends) return root;
  const FileName name = name_of_base(*extends->value);
  const fs::path base_file = find_file(name, "study");
  std::error_code error;
  readers.push_back(fs::canonical(file, error));
  if (std::ranges::find(readers, fs::canonical(base_file, error)) != readers.end())
    throw ConfigError(
        fmt::format("{}: extends: {} extends this study itself", name.where, base_file.string()));
  if (readers.size() > kMostExtended)
    throw ConfigError(
        fmt::format("{}: extends: more than {} studies in a row", name.where, kMostExtended));
  auto base = read(base_file, readers);
  if (!is_map(*base))
    throw ConfigError(
        fmt::format("{}: extends: {} is no study; expected a map with title, scenes, "
                    "grid, ...",
                    name.where, base_file.string()));
  root->entries.erase(root->entries.begin() + (extends - root->entries.data()));
  if (!base->find("directory")) {
    auto directory = make_scalar(base->origin->directory.string(), false);
    directory->origin = base->origin;
    base->add("directory", std::move(directory));
  }
  add_to(*base, *root);
  return base;
}

}  // namespace

std::unique_ptr<YamlNode> read_study_file(const fs::path& file) {
  std::vector<fs::path> readers;
  return read(file, readers);
}

}  // namespace hypotrack::detail::internal
