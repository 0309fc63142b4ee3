#pragma once

#include <array>

#include "hypotrack/plugin/params.hpp"

namespace hypotrack::test {

enum class Mode { kNearest, kBilinear };
inline std::span<const std::string_view> enum_names(Mode) {
  static constexpr std::array<std::string_view, 2> kNames = {"nearest", "bilinear"};
  return kNames;
}

struct SampleSection {
  int depth = 1;
  void visit(ParamVisitor& v) { v("depth", depth, {.help = "how deep", .min = 0}); }
};

struct SamplePart {
  double size = 1;
  std::string label;
  void visit(ParamVisitor& v) {
    v("size", size, {.help = "how large"});
    v("label", label, {.help = "what it is called"});
  }
};

/// With a path that a scene may do without.
struct OptionalFile {
  std::filesystem::path file;
  void visit(ParamVisitor& v) { v("file", file, {.help = "a file"}); }
};

/// One parameter of every type.
struct SampleParams {
  int particles = 64;
  double radius = 3 * kMillimetre;
  double range = 10 * kDegree;
  std::string name = "default";
  bool enabled = true;
  std::uint8_t small = 7;
  Mode mode = Mode::kNearest;
  std::filesystem::path file;
  Eigen::Vector3d center{0, 0, 0.5};
  std::vector<double> weights = {0.25, 0.75};
  std::vector<std::string> words;
  std::optional<double> maybe;
  SampleSection inner;
  std::vector<SamplePart> parts = {{9, "nine"}, {10, "ten"}};
  ConfigNode nested;

  void visit(ParamVisitor& v) {
    v("particles", particles, {.help = "particles of the swarm", .min = 2, .max = 1 << 20});
    v("radius_mm", radius, {.help = "of a sphere", .min = 0, .unit = "mm", .to_si = kMillimetre});
    v("range_deg", range,
      {.help = "of a joint", .min = 0, .max = 180, .unit = "deg", .to_si = kDegree});
    v("name", name, {.help = "a name"});
    v("enabled", enabled, {.help = "whether to"});
    v("small", small, {.help = "a byte"});
    v("mode", mode, {.help = "lookup"});
    v("file", file, {.help = "an image", .required = true});
    v("center", center, {.help = "of the sphere", .unit = "mm", .to_si = kMillimetre});
    v("weights", weights, {.help = "of the terms", .min = 0, .max = 1});
    v("words", words, {.help = "some words"});
    v("maybe", maybe, {.help = "perhaps"});
    v("inner", inner, {.help = "a section"});
    v("parts", parts, {.help = "the parts"});
    v("nested", nested, {.help = "a plugin"});
  }
};

}  // namespace hypotrack::test
