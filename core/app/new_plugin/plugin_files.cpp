#include "new_plugin/plugin_files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <regex>

#include "hypotrack/api/error.hpp"

namespace hypotrack::app {
namespace {

/// What the guide's example of a kind is called, and how scenes name it.
struct Example {
  std::string kind, name;
  std::vector<std::string> files;  ///< of the guide
  std::string cmake;               ///< more arguments of hypotrack_add_plugin()
  std::string parameters;          ///< in a scene
  bool cuda = false;
};

const std::vector<Example>& examples() {
  static const std::vector<Example> all{
      {"objective", "silhouette", {"silhouette.cpp"}, "", ""},
      {"objective",
       "fast_silhouette",
       {"fast_silhouette-inl.hpp", "fast_silhouette.hpp", "fast_silhouette.cpp",
        "fast_silhouette.cu", "no_cuda.cpp"},
       "\n  CUDA_SOURCES fast_silhouette.cu NO_CUDA_SOURCES no_cuda.cpp LIBRARIES hwy",
       "",
       true},
      {"optimizer", "hill_climb", {"hill_climb.cpp"}, "", ", rounds: 30"},
      {"model", "can", {"can.cpp"}, "", ", radius_mm: 30"},
      {"source",
       "euroc",
       {"euroc.cpp"},
       "\n  CONTRACT_CONFIG contract.yaml",
       ", folder: recording"},
      {"starter", "in_front", {"in_front.cpp"}, "", ", distance_mm: 500"},
      {"judge", "same_colors", {"same_colors.cpp"}, "", ""},
      {"output", "trajectory", {"trajectory.cpp"}, "", ""}};
  return all;
}

std::string camel_case(const std::string& name) {
  std::string out;
  bool upper = true;
  for (const char c : name) {
    if (c != '_') out += upper ? static_cast<char>(std::toupper(c)) : c;
    upper = c == '_';
  }
  return out;
}

std::string upper_case(std::string name) {
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::toupper(c); });
  return name;
}

/// Replaces an example's names in a text: of its class, its files, its namespace, its messages.
std::string renamed(std::string text, const Example& example, const std::string& name) {
  // A word of its own may also be one of a sentence.
  const bool is_word = example.name.find('_') == std::string::npos;
  const std::string own = is_word ? "\"" + example.name + "(?=: )" : "\\b" + example.name;
  text = std::regex_replace(text, std::regex(own), is_word ? "\"" + name : name);
  text = std::regex_replace(text, std::regex("\\b" + camel_case(example.name) + "\\b"),
                            camel_case(name));
  return std::regex_replace(text, std::regex("\\b" + upper_case(example.name)), upper_case(name));
}

void expect_name(const std::string& name) {
  static const std::regex kName("[a-z][a-z0-9_]*");
  static const std::vector<std::string> kTaken{
      "auto",    "bool",      "break",    "case",     "catch",    "char",    "class",
      "concept", "const",     "delete",   "do",       "export",   "false",   "goto",
      "import",  "nullptr",   "register", "requires", "sizeof",   "true",    "double",
      "else",    "enum",      "explicit", "extern",   "float",    "for",     "friend",
      "hwy",     "hypotrack", "if",       "inline",   "int",      "long",    "namespace",
      "new",     "operator",  "private",  "public",   "return",   "short",   "signed",
      "static",  "std",       "struct",   "switch",   "template", "this",    "throw",
      "try",     "typename",  "union",    "unsigned", "using",    "virtual", "void",
      "while"};
  if (!std::regex_match(name, kName) || name.ends_with('_'))
    throw ConfigError(fmt::format(
        "found the name '{}', expected small letters, digits and _, a letter first: my_plugin",
        name));
  if (std::ranges::find(kTaken, name) != kTaken.end())
    throw ConfigError(fmt::format(
        "found the name '{}', which C++ code cannot use as its own; take another", name));
}

const Example& example_of(const PluginRequest& request) {
  for (const Example& example : examples())
    if (example.kind == request.kind && example.cuda == request.cuda) return example;
  const std::vector<std::string> kinds = plugin_kinds();
  if (std::ranges::find(kinds, request.kind) == kinds.end())
    throw ConfigError(fmt::format("found the kind '{}', expected one of {}", request.kind,
                                  fmt::join(kinds, ", ")));
  throw ConfigError(fmt::format(
      "--cuda: only an objective has a part for GPUs; leave it out for {}", request.kind));
}

/// A scene in which one line names the plugin, with what else it needs.
std::string scene_text(const std::string& kind, const std::string& plugin) {
  const auto part = [&](const char* key, const std::string& usual) {
    return kind == key ? plugin : usual;
  };
  const std::string model = part("model", "type: rigid_box, size_mm: [50, 100, 30]");
  const std::string rendered =
      "\n  type: synthetic\n  frames: 10\n  cameras: {width: 320, height: 240, focal_px: 300}\n"
      "  keyframes:\n"
      "    - {time: 0, pose: {object: {position_mm: [0, 0, 500]}}}\n"
      "    - {time: 1, pose: {object: {position_mm: [60, 20, 520], rotation_deg: [0, 0, 60]}}}";
  std::string out = "models:\n  - {name: object, " + model +
                    "}\nsource:" + (kind == "source" ? " {" + plugin + "}" : rendered) + "\n";
  out += "objective: {" + part("objective", "type: stereo_color") + "}\n";
  out += "optimizer: {" + part("optimizer", "type: pso, particles: 64, generations: 24") + "}\n";
  if (kind == "starter")
    out += "init: {from: {" + plugin + "}}\n";
  else if (kind == "source")
    out += "init: {pose: {object: {position_mm: [0, 0, 500]}}}\n";
  else
    out += "init: {from: truth}\n";
  if (kind == "judge") out += "judge: {" + plugin + "}\n";
  if (kind == "output") out += "output: {also: {" + plugin + "}}\n";
  return out;
}

}  // namespace

std::vector<std::string> plugin_kinds() {
  std::vector<std::string> out;
  for (const Example& example : examples())
    if (!example.cuda) out.push_back(example.kind);
  return out;
}

std::map<std::string, std::string> plugin_files(const PluginRequest& request,
                                                const std::map<std::string, std::string>& guide) {
  expect_name(request.name);
  const Example& example = example_of(request);
  std::map<std::string, std::string> out;
  for (const std::string& file : example.files) {
    const auto found = guide.find(file);
    if (found == guide.end())
      throw DataError("the guide of this installation does not show " + file +
                      "; install hypotrack again");
    const std::string name =
        file.starts_with(example.name) ? request.name + file.substr(example.name.size()) : file;
    out[name] = renamed(found->second, example, request.name);
  }
  out["CMakeLists.txt"] = fmt::format(
      "cmake_minimum_required(VERSION 3.25)\n"
      "project({0} VERSION 1.0 LANGUAGES CXX)\n"
      "find_package(hypotrack REQUIRED)\n"
      "enable_testing()  # the tests of what every {1} holds\n\n"
      "hypotrack_add_plugin({1} {0} {0}.cpp{2})\n",
      request.name, request.kind, renamed(example.cmake, example, request.name));
  const std::string plugin = "type: " + request.name + example.parameters;
  out["scene.yaml"] = scene_text(request.kind, plugin);
  if (request.kind == "source") out["contract.yaml"] = "folder: recording\n";
  return out;
}

std::string rendered_scene() { return scene_text("", ""); }

}  // namespace hypotrack::app
