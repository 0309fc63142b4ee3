#pragma once

#include <filesystem>
#include <fstream>
#include <regex>
#include <stdexcept>
#include <string>
#include <string_view>

#include "hypotrack/api/config.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/params.hpp"
#include "sample_params.hpp"

namespace hypotrack::test {

/// Whether two nodes hold the same values in the same order.
inline bool same_content(const ConfigNode& a, const ConfigNode& b) {
  if (a.is_map() != b.is_map() || a.is_list() != b.is_list() || a.is_null() != b.is_null() ||
      a.scalar() != b.scalar() || a.size() != b.size() || a.keys() != b.keys()) {
    return false;
  }
  for (const std::string& key : a.keys()) {
    if (!same_content(a.get(key), b.get(key))) return false;
  }
  for (std::size_t i = 0; a.is_list() && i < a.size(); ++i) {
    if (!same_content(a.at(i), b.at(i))) return false;
  }
  return true;
}

/// Writes a scene and a tracker that others in the folder may include.
inline void write_other_scene(const std::filesystem::path& folder) {
  std::ofstream(folder / "other.yaml")
      << "optimizer: {file: a.png, particles: 8, words: [a, b]}\nempty:\n";
  std::filesystem::create_directories(folder / "trackers");
  std::ofstream(folder / "trackers" / "quick.yaml")
      << "optimizer: {file: b.png, particles: 4, words: [c]}\ntracker: {history: 40}\n";
}

/// Reads a text the way a scene is read, as `scene.yaml` of a folder. Whatever it holds, it is read
/// or refused with a ConfigError that says where; anything else leaves this function as an
/// exception. Returns whether it was read to the end.
inline bool read_scene(std::string_view text, const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "scene.yaml";
  std::ofstream(file, std::ios::binary) << text;
  try {
    const ConfigNode root = ConfigNode::load_scene(file);
    // Writing and reading again changes nothing, but may reach the limit on sizes.
    const std::string written = root.to_yaml();
    if (!same_content(root, ConfigNode::parse(written, file.string(), folder))) {
      throw std::logic_error("written and read again it is another scene:\n" + written);
    }
    const ConfigNode optimizer = root.get("optimizer");
    dump_params(ParamReader(optimizer, {"type"}).read<SampleParams>());
    return true;
  } catch (const ConfigError& error) {
    // A value may come from another file: of this folder or of those that the program brings.
    static const std::regex position("^/[^:]*\\.yaml:[0-9]+:[0-9]+: ");
    const std::string message = error.what();
    if (!message.starts_with(file.string() + ":") && !std::regex_search(message, position)) {
      throw std::logic_error("no position: " + message);
    }
    return false;
  }
}

}  // namespace hypotrack::test
