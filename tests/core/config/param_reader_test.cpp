#include <array>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/params.hpp"
#include "sample_params.hpp"

namespace hypotrack::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

SampleParams read(std::string_view text, std::vector<std::string> also = {}) {
  return ParamReader(ConfigNode::parse(text, "scene.yaml", "/scenes"), std::move(also))
      .read<SampleParams>();
}

std::string error(std::string_view text) {
  return message_of<ConfigError>([&] { read(text); });
}

/// With one limit of its own and one of its type.
struct Counted {
  int count = 1;
  void visit(ParamVisitor& v) { v("count", count, {.help = "how many", .min = 0}); }
};

TEST(ParamReader, LeavesDefaultsWhereNothingIsGiven) {
  const SampleParams params = read("file: a.png");
  const SampleParams defaults;
  EXPECT_EQ(params.particles, defaults.particles);
  EXPECT_EQ(params.range, defaults.range);
  EXPECT_EQ(params.parts.size(), defaults.parts.size());
  EXPECT_FALSE(params.maybe.has_value());
}

TEST(ParamReader, ReadsEveryType) {
  const SampleParams params = read(
      "file: a.png\nparticles: 1e3\nradius_mm: 2.5\nrange_deg: 90\nname: '12'\nenabled: false\n"
      "mode: bilinear\ncenter: [1, 2, 3]\nweights: [0.5]\nwords: [a, 'b c']\nmaybe: 4\n"
      "inner: {depth: 3}\nparts:\n  - {size: 5}\n  - {size: 6, label: x}\nnested: {type: pso}\n");
  EXPECT_EQ(params.particles, 1000);
  EXPECT_EQ(params.radius, 2.5 * 1e-3);
  EXPECT_EQ(params.range, 90 * kDegree);
  EXPECT_EQ(params.name, "12");
  EXPECT_FALSE(params.enabled);
  EXPECT_EQ(params.mode, Mode::kBilinear);
  EXPECT_EQ(params.center, Eigen::Vector3d(1e-3, 2e-3, 3e-3));
  EXPECT_THAT(params.weights, ElementsAre(0.5));
  EXPECT_THAT(params.words, ElementsAre("a", "b c"));
  EXPECT_EQ(params.maybe, 4.0);
  EXPECT_EQ(params.inner.depth, 3);
  ASSERT_EQ(params.parts.size(), 2u);
  EXPECT_EQ(params.parts[1].size, 6.0);
  EXPECT_EQ(params.parts[1].label, "x");
  EXPECT_EQ(params.nested.get("type").scalar(), "pso");
}

TEST(ParamReader, GivenListsDoNotMixWithDefaultOnes) {
  const SampleParams params = read("file: a\nparts: [{label: only}]\n");
  ASSERT_EQ(params.parts.size(), 1u);
  EXPECT_EQ(params.parts[0].label, "only");
  EXPECT_EQ(params.parts[0].size, SamplePart{}.size) << "the default list's item has another size";
}

TEST(ParamReader, UnknownKeysNameTheNearestAndAll) {
  EXPECT_THAT(error("file: a\nname: b\npartikles: 3\n"),
              StartsWith("scene.yaml:3:1: partikles: unknown key; did you mean 'particles'? "
                         "Allowed: particles, radius_mm, range_deg, name,"));
  EXPECT_THAT(error("file: a\nzzz: 3\n"),
              StartsWith("scene.yaml:2:1: zzz: unknown key. Allowed: particles,"));
}

TEST(ParamReader, MessagesNameThePathFromTheRoot) {
  const ConfigNode root = ConfigNode::parse("optimizer:\n  file: a\n  partikles: 3\n", "s.yaml");
  EXPECT_THAT(message_of<ConfigError>(
                  [&] { ParamReader(root.get("optimizer"), {"type"}).read<SampleParams>(); }),
              AllOf(StartsWith("s.yaml:3:3: optimizer.partikles: unknown key; did you mean"),
                    HasSubstr(", type")));
}

TEST(ParamReader, UnknownKeysInSectionsAndListsHaveTheirOwnPlace) {
  EXPECT_EQ(error("file: a\ninner:\n  depht: 3\n"),
            "scene.yaml:3:3: inner.depht: unknown key; did you mean 'depth'? Allowed: depth");
  EXPECT_EQ(error("file: a\nparts:\n  - size: 3\n  - {size: 4, colour: 5}\n"),
            "scene.yaml:4:15: parts.1.colour: unknown key. Allowed: size, label");
}

TEST(ParamReader, KeysOfOthersArePassedOver) {
  EXPECT_NO_THROW(read("file: a\ntype: pso\nweight: [whatever]\n", {"type", "weight"}));
}

TEST(ParamReader, MissingRequiredKeys) {
  EXPECT_EQ(error("name: a\n"), "scene.yaml:1:1: file: required key is missing");
  EXPECT_THAT(error("fiel: a\n"), HasSubstr("fiel: unknown key; did you mean 'file'?"))
      << "a misspelt required key is unknown, not missing";
  EXPECT_EQ(error("file: \"\"\n"), "scene.yaml:1:7: file: expected a path, found the text \"\"");
}

TEST(ParamReader, AbsentSectionIsReadAsAnEmptyMap) {
  const ConfigNode root = ConfigNode::parse("a: 1\n", "s.yaml");
  EXPECT_EQ(message_of<ConfigError>([&] { ParamReader(root.get("tracker")).read<SampleParams>(); }),
            "s.yaml:1:1: tracker.file: required key is missing");
}

TEST(ParamReader, WrongTypes) {
  EXPECT_EQ(error("file: a\nparticles: many\n"),
            "scene.yaml:2:12: particles: expected an integer from 2 to 1048576, found 'many'");
  EXPECT_EQ(error("file: a\nparticles: 1.5\n"),
            "scene.yaml:2:12: particles: expected an integer from 2 to 1048576, found '1.5'");
  EXPECT_EQ(error("file: a\nparticles: '64'\n"),
            "scene.yaml:2:12: particles: expected an integer from 2 to 1048576, found the text "
            "\"64\"");
  EXPECT_EQ(error("file: a\nradius_mm: [1, 2]\n"),
            "scene.yaml:2:12: radius_mm: expected a number at least 0 mm, found a list of 2");
  EXPECT_EQ(error("file: a\nname: {b: 1}\n"), "scene.yaml:2:7: name: expected a text, found a map");
  EXPECT_EQ(error("file: [a]\n"), "scene.yaml:1:7: file: expected a path, found a list of 1");
  EXPECT_EQ(error("file: a\ninner: 3\n"),
            "scene.yaml:2:8: inner: expected a map of parameters, found '3'");
  EXPECT_EQ(error("file: a\nparts: {size: 3}\n"),
            "scene.yaml:2:8: parts: expected a list of maps, found a map");
  EXPECT_EQ(error("file: a\nparts: {}\n"),
            "scene.yaml:2:8: parts: expected a list of maps, found an empty map");
  EXPECT_EQ(error("file: a\nparts: [3]\n"),
            "scene.yaml:2:9: parts.0: expected a map of parameters, found '3'");
  EXPECT_EQ(error("file: a\nwords: a\n"),
            "scene.yaml:2:8: words: expected a list of texts, found 'a'");
  EXPECT_EQ(error("file: a\nwords: [[a]]\n"),
            "scene.yaml:2:9: words.0: expected a text, found a list of 1");
  EXPECT_EQ(error("[1, 2]"), "scene.yaml:1:1: expected a map of parameters, found a list of 2");
}

TEST(ParamReader, NullIsNoValue) {
  EXPECT_EQ(
      error("file: a\nparticles:\n"),
      "scene.yaml:2:1: particles: is null; expected an integer from 2 to 1048576 (a key that has a "
      "default may be left out)");
  for (const auto* key : {"radius_mm", "name", "enabled", "center", "weights", "words", "maybe",
                          "inner", "parts", "file"}) {
    EXPECT_THAT(error("{file: a, " + std::string(key) + ": ~}"),
                key == std::string("file") ? HasSubstr("duplicate key") : HasSubstr("is null;"))
        << key;
  }
  EXPECT_THAT(error("{file: ~}"), HasSubstr("file: is null; expected a path"));
  EXPECT_THAT(error("{file: a, mode: ~}"),
              HasSubstr("expected one of nearest, bilinear; found null"));
}

TEST(ParamReader, OutOfRange) {
  EXPECT_EQ(error("file: a\nparticles: 1\n"),
            "scene.yaml:2:12: particles: 1 is out of range; expected an integer from 2 to 1048576");
  EXPECT_EQ(error("file: a\nradius_mm: -1\n"),
            "scene.yaml:2:12: radius_mm: -1 is out of range; expected a number at least 0 mm");
  EXPECT_EQ(error("file: a\nrange_deg: 180.001\n"),
            "scene.yaml:2:12: range_deg: 180.001 is out of range; expected a number from 0 to 180 "
            "deg");
  EXPECT_EQ(error("file: a\nweights: [0.5, 2]\n"),
            "scene.yaml:2:16: weights.1: 2 is out of range; expected a number from 0 to 1");
  EXPECT_EQ(error("file: a\nsmall: 300\n"),
            "scene.yaml:2:8: small: 300 is out of range; expected an integer from 0 to 255");
  EXPECT_NO_THROW(read("{file: a, range_deg: 180, particles: 2}"));
  EXPECT_THAT(message_of<ConfigError>([] {
                ParamReader(ConfigNode::parse("count: 99999999999", "scene.yaml")).read<Counted>();
              }),
              HasSubstr("expected an integer from 0 to 2147483647"));
}

TEST(ParamReader, InfinityOnlyWhereTheRangeAllowsAndNanNever) {
  EXPECT_TRUE(std::isinf(read("{file: a, radius_mm: .inf}").radius));
  EXPECT_THAT(error("{file: a, range_deg: .inf}"), HasSubstr(".inf is out of range; expected"));
  EXPECT_THAT(error("{file: a, radius_mm: -.inf}"), HasSubstr("-.inf is out of range; expected"));
  EXPECT_THAT(error("{file: a, radius_mm: .nan}"),
              HasSubstr("radius_mm: expected a number at least 0 mm, found not-a-number"));
  EXPECT_THAT(error("{file: a, particles: .inf}"), HasSubstr("expected an integer"));
}

TEST(ParamReader, WrongLength) {
  EXPECT_EQ(error("file: a\ncenter: [1, 2]\n"),
            "scene.yaml:2:9: center: expected a list of 3 numbers in mm, found 2");
  EXPECT_THAT(error("file: a\ncenter: 1\n"),
              HasSubstr("expected a list of 3 numbers in mm, found '1'"));
}

TEST(ParamReader, BoolsAreTrueAndFalseOnly) {
  for (const auto* text : {"yes", "no", "on", "off", "1", "True", "'true'"}) {
    EXPECT_THAT(
        error("{file: a, enabled: " + std::string(text) + "}"),
        HasSubstr("enabled: expected true or false (yes, no, on and off are no bools in YAML "
                  "1.2), found "));
  }
}

TEST(ParamReader, EnumWords) {
  EXPECT_EQ(
      error("file: a\nmode: bilinaer\n"),
      "scene.yaml:2:7: mode: expected one of nearest, bilinear; found 'bilinaer'; did you mean "
      "'bilinear'?");
  EXPECT_EQ(error("file: a\nmode: [nearest]\n"),
            "scene.yaml:2:7: mode: expected one of nearest, bilinear; found a list of 1");
}

TEST(ParamReader, PathsAreRelativeToTheirFile) {
  EXPECT_EQ(read("file: images/../a.png").file, "/scenes/a.png");
  EXPECT_EQ(read("file: /b.png").file, "/b.png");
  const ConfigNode none = ConfigNode::parse("file: ''", "scene.yaml", "/scenes");
  EXPECT_EQ(ParamReader(none).read<OptionalFile>().file, "");
}

}  // namespace
}  // namespace hypotrack::test
