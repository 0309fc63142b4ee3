#include <fstream>

#include "config/yaml_text.hpp"
#include "expect_error.hpp"
#include "hypotrack/api/config.hpp"
#include "hypotrack/api/error.hpp"
#include "parse_error.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

using test::message_of;
using test::parse_error;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string repeat(std::string_view text, int count) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text;
  return all;
}

TEST(YamlLimits, SixtyFourLevelsAreRead) {
  EXPECT_NO_THROW(ConfigNode::parse(repeat("[", 64) + repeat("]", 64), "scene.yaml"));
  EXPECT_THAT(parse_error(repeat("[", 65) + repeat("]", 65)),
              EndsWith(": nested deeper than 64 levels"));
}

TEST(YamlLimits, DeepNestingOfEveryStyleIsRefusedWithoutRecursing) {
  const int many = 50'000;
  std::string indented;
  for (int i = 0; i < 1000; ++i) indented += std::string(static_cast<std::size_t>(i), ' ') + "a:\n";
  for (const std::string& text :
       {repeat("[", many), repeat("{a: ", many), repeat("- ", many), repeat("? ", many),
        repeat("[a: ", many), repeat("{? ", many), indented}) {
    EXPECT_THAT(parse_error(text), StartsWith("scene.yaml:")) << text.substr(0, 20);
  }
}

TEST(YamlLimits, AliasBombIsRefusedAtItsFirstAnchor) {
  std::string bomb = "a0: &a0 [x, x]\n";
  for (int i = 1; i < 40; ++i) {
    const auto n = std::to_string(i), p = std::to_string(i - 1);
    bomb += "a" + n + ": &a" + n + " [*a" + p + ", *a" + p + "]\n";
  }
  EXPECT_THAT(parse_error(bomb), StartsWith("scene.yaml:1:5: anchor '&a0'"));
}

TEST(YamlLimits, LargeTextsAndFilesAreRefused) {
  const std::string large = "a: 1\n" + std::string(std::size_t{8} << 20, '#');
  EXPECT_EQ(parse_error(large), "scene.yaml: is larger than 8 MiB, which no scene needs");
  const test::TemporaryDirectory folder;
  const auto file = folder.path() / "large.yaml";
  std::ofstream(file) << large;
  EXPECT_EQ(message_of<ConfigError>([&] { ConfigNode::load(file); }),
            file.string() + ": is larger than 8 MiB, which no scene needs");
}

TEST(YamlLimits, ManyValuesOnOneLineAreRefusedInLinearTime) {
  EXPECT_THAT(parse_error("[" + repeat("[],", 1'100'000) + "]"),
              EndsWith(": more than 1000000 values, which no scene needs"));
}

TEST(YamlLimits, EndlessFilesAreRefused) {
  EXPECT_THAT(message_of<ConfigError>([&] { ConfigNode::load("/dev/zero"); }),
              HasSubstr("is larger than 8 MiB"));
}

TEST(YamlLimits, ControlCharactersAndOtherEncodingsAreRefused) {
  EXPECT_EQ(parse_error("a: 1\nb: \x04 2\n"),
            "scene.yaml:2:4: found the control character 0x04; expected UTF-8 text");
  EXPECT_EQ(parse_error(std::string_view("a: \0", 4)),
            "scene.yaml:1:4: found the control character 0x00; expected UTF-8 text");
  EXPECT_EQ(parse_error("a: gr\xF6\xDF"
                        "e\n"),
            "scene.yaml:1:6: no UTF-8: found byte 0xF6; expected UTF-8 text");
  EXPECT_THAT(parse_error(std::string_view("\xFF\xFE"
                                           "a\0:\0",
                                           6)),
              StartsWith("scene.yaml:1:1: no UTF-8: found byte 0xFF"));
  for (const std::string noncharacter : {"\xEF\xBF\xBF", "\xEF\xB7\x90", "\xF0\x9F\xBF\xBE"}) {
    EXPECT_THAT(parse_error("a: " + noncharacter),
                StartsWith("scene.yaml:1:4: found the bytes of no character, from 0x"));
  }
  EXPECT_NO_THROW(ConfigNode::parse("a: \xEF\xBF\xBD", "scene.yaml"));  // U+FFFD is one
}

TEST(YamlLimits, SmallFilesTakeLittleMemory) {
  const test::TemporaryDirectory folder;
  const auto file = folder.path() / "scene.yaml";
  std::ofstream(file) << "a: 1\n";
  const std::string text = detail::read_text_file(file);
  EXPECT_EQ(text, "a: 1\n");
  EXPECT_LT(text.capacity(), 1u << 17);
}

}  // namespace
}  // namespace hypotrack
