#include "hypotrack/api/config_value.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <limits>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/params.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

using test::message_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using Value = ConfigValue;

struct Inner {
  double length = 0;
  std::filesystem::path file;
  void visit(ParamVisitor& v) {
    v("length_mm", length, {.help = "a length", .max = 10, .unit = "mm", .to_si = kMillimetre});
    v("file", file, {.help = "a file"});
  }
};
struct Params {
  int count = 0;
  bool on = false;
  std::string word;
  std::vector<double> numbers;
  Inner inner;
  void visit(ParamVisitor& v) {
    v("count", count, {.help = "a number", .required = true});
    v("on", on, {.help = "a switch"});
    v("word", word, {.help = "a word"});
    v("numbers", numbers, {.help = "numbers"});
    v("inner", inner, {.help = "more"});
  }
};

Params read(const Value& value) {
  return ParamReader(value.document("my scene", "/folder")).read<Params>();
}
std::string error_of(const Value& value) {
  return message_of<ConfigError>([&] { read(value); });
}

TEST(ConfigValue, IsReadAsAFileWithTheSameValues) {
  const Params read_back =
      read(Value::map({{"count", 7},
                       {"on", true},
                       {"word", "1e3"},
                       {"numbers", Value::list({0.1, -2, 1e300})},
                       {"inner", Value::map({{"length_mm", 2.5}, {"file", "a/../b.png"}})}}));
  EXPECT_EQ(read_back.count, 7);
  EXPECT_TRUE(read_back.on);
  EXPECT_EQ(read_back.word, "1e3") << "a text stays one";
  EXPECT_THAT(read_back.numbers, ElementsAre(0.1, -2, 1e300));
  EXPECT_DOUBLE_EQ(read_back.inner.length, 0.0025);
  EXPECT_EQ(read_back.inner.file, "/folder/b.png");
}

TEST(ConfigValue, KeepsNumbersToTheLastBit) {
  for (const double number : {0.1, 1.0 / 3, std::numeric_limits<double>::denorm_min(), 4.0, -0.0}) {
    const Params back = read(Value::map({{"count", 1}, {"numbers", Value::list({number})}}));
    EXPECT_EQ(back.numbers.front(), number);
  }
  EXPECT_EQ(read(Value::map({{"count", 64.0}})).count, 64) << "a whole number is an integer";
}

TEST(ConfigValue, MistakesNameTheDocumentAndTheKeyPathOnce) {
  EXPECT_EQ(error_of(Value::map({{"count", "many"}})),
            "my scene: count: expected an integer, found the text \"many\"");
  EXPECT_EQ(error_of(Value::map({{"on", true}})), "my scene: count: required key is missing");
  EXPECT_THAT(error_of(Value::map({{"count", 1}, {"inner", Value::map({{"length_mn", 1}})}})),
              StartsWith("my scene: inner.length_mn: unknown key; did you mean 'length_mm'?"));
  EXPECT_THAT(error_of(Value::map({{"count", 1}, {"numbers", Value::list({1, "two"})}})),
              StartsWith("my scene: numbers.1: expected a number"));
  EXPECT_THAT(error_of(Value::map({{"count", 1}, {"inner", Value::map({{"length_mm", 11}})}})),
              StartsWith("my scene: inner.length_mm: 11 is out of range"));
  EXPECT_THAT(error_of(Value::list({1})), StartsWith("my scene: expected a map of parameters"));
  EXPECT_THAT(error_of(Value::map({{"count", Value()}})), StartsWith("my scene: count: is null"));
  EXPECT_THAT(error_of(Value::map({{"count", 1}, {"numbers", Value::list({NAN})}})),
              HasSubstr("found not-a-number"));
}

TEST(ConfigValue, TakesOverridesReferencesAndTrackers) {
  const test::TemporaryDirectory folder;
  std::ofstream(folder.path() / "other.yaml") << "models: [{type: cup, file: cup.obj}]\nseed: 5\n";
  std::ofstream(folder.path() / "fast.yaml")
      << "objective: {type: edges}\noptimizer: {type: pso}\nsearch: {second_search: 0.5}\n";
  const ConfigNode scene =
      Value::map({{"models", "@other.yaml"},
                  {"seed", "@other.yaml#seed"},
                  {"search", Value::map({{"angle_deg", 5}})},
                  {"tracker", Value::map({{"from", "@fast.yaml"}, {"patience", 1}})}})
          .document("my scene", folder.path())
          .as_scene(std::vector<std::string>{"optimizer.particles=8", "extra=\"@seed\""});
  EXPECT_EQ(scene.get("models").at(0).get("type").scalar(), "cup");
  EXPECT_THAT(scene.get("models").at(0).where(), HasSubstr("other.yaml:1:10"));
  EXPECT_EQ(scene.get("seed").scalar(), "5");
  EXPECT_EQ(scene.get("extra").scalar(), "5");
  EXPECT_EQ(scene.get("optimizer").get("type").scalar(), "pso");
  EXPECT_EQ(scene.get("optimizer").get("particles").where(), "--set optimizer.particles=8");
  EXPECT_EQ(scene.get("search").get("second_search").scalar(), "0.5") << "maps are joined";
  EXPECT_EQ(scene.get("search").get("angle_deg").where(), "my scene: search.angle_deg");
  EXPECT_EQ(scene.get("status").get("patience").scalar(), "1");
}

TEST(ConfigValue, FormerKeysAreNamedByTheirKeyPath) {
  std::vector<std::string> notes;
  const auto scene = [&](const Value& tracker) {
    return Value::map({{"seed", 1}, {"tracker", tracker}})
        .document("my scene", "/folder")
        .as_scene({}, &notes);
  };
  EXPECT_EQ(scene(Value::map({{"patience", 1}})).get("status").get("patience").scalar(), "1");
  EXPECT_THAT(notes, testing::ElementsAre(StartsWith("my scene: tracker: `tracker.patience` is ")));
  const auto error = [&](const char* key, const Value& value) {
    return message_of<ConfigError>([&] { (void)scene(Value::map({{key, value}})); });
  };
  EXPECT_THAT(error("patient", 1), StartsWith("my scene: tracker.patient: found the key"));
  EXPECT_THAT(error("evidence", "perhaps"), StartsWith("my scene: tracker.evidence: "));
}

TEST(ConfigValue, ReferencesToNothingNameTheKeyPath) {
  const auto error = [](const Value& value) {
    return message_of<ConfigError>([&] { (void)value.document("my scene", "/folder").as_scene(); });
  };
  EXPECT_THAT(error(Value::map({{"tracker", "@trackers/recomended"}})),
              StartsWith("my scene: tracker: there is no tracker '@trackers/recomended'"));
  EXPECT_THAT(error(Value::map({{"a", Value::list({"@none.yaml"})}})),
              StartsWith("my scene: a.0: '@none.yaml' cannot be included"));
}

TEST(ConfigValue, RefusesWhatNoDocumentHolds) {
  EXPECT_THAT(message_of<ConfigError>([] {
                Value::map({{"a", 1}, {"a", 2}});
              }),
              HasSubstr("has the key 'a' twice"));
  EXPECT_THAT(error_of(Value::map({{"word", "\xff"}})),
              StartsWith("my scene: word: expected UTF-8 text"));
  EXPECT_THAT(error_of(Value::map({{"word", std::string("a\0b", 3)}})),
              StartsWith("my scene: word: expected UTF-8 text"));
  Value deep;
  for (int i = 0; i < 70; ++i) deep = Value::list({deep});
  EXPECT_EQ(error_of(deep), "my scene: nested deeper than 64 levels");
}

TEST(ConfigValue, IsWrittenAsYamlThatReadsBackEqual) {
  const Value value = Value::map({{"text", "yes"},
                                  {"list", Value::list({1, 0.5, true, Value(), "a: b\n"})},
                                  {"map", Value::map({})}});
  const std::string text = value.document("my scene").to_yaml();
  EXPECT_EQ(ConfigNode::parse(text, "read back").to_yaml(), text);
}

}  // namespace
}  // namespace hypotrack
