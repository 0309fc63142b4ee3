#include <fstream>

#include "expect_error.hpp"
#include "hypotrack/api/config.hpp"
#include "hypotrack/api/error.hpp"
#include "parse_error.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

using test::message_of;
using test::parse_error;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

ConfigNode parse(std::string_view text) { return ConfigNode::parse(text, "scene.yaml"); }

TEST(ConfigNode, DefaultIsUndefined) {
  const ConfigNode node;
  EXPECT_FALSE(node.defined());
  EXPECT_FALSE(node.is_map() || node.is_list() || node.is_scalar() || node.is_null());
  EXPECT_EQ(node.size(), 0u);
  EXPECT_EQ(node.scalar(), "");
  EXPECT_EQ(node.to_yaml(), "");
  EXPECT_FALSE(node.get("key").at(3).defined());
  EXPECT_EQ(node.get("key").at(3).path(), "key.3");
}

TEST(ConfigNode, KnowsKindsAndOrder) {
  const ConfigNode root = parse("b: 1\na: [x, 'y']\nc: {d: ~}\ne:\n");
  EXPECT_TRUE(root.is_map());
  EXPECT_THAT(root.keys(), ElementsAre("b", "a", "c", "e"));
  EXPECT_TRUE(root.get("a").is_list());
  EXPECT_EQ(root.get("a").size(), 2u);
  EXPECT_TRUE(root.get("a").at(0).is_plain());
  EXPECT_FALSE(root.get("a").at(1).is_plain());
  EXPECT_EQ(root.get("a").at(1).scalar(), "y");
  EXPECT_TRUE(root.get("c").get("d").is_null());
  EXPECT_TRUE(root.get("e").is_null());
  EXPECT_FALSE(root.get("b").is_null());
}

TEST(ConfigNode, EmptyFileIsAnEmptyMap) {
  for (const auto* text : {"", "\n\n", "# only a comment\n", "---\n"}) {
    EXPECT_TRUE(parse(text).is_map()) << text;
    EXPECT_EQ(parse(text).size(), 0u) << text;
  }
}

TEST(ConfigNode, AMapOfNodesKeepsTheirPositions) {
  const ConfigNode init = parse("init:\n  from: pso\n  frame: 3\n").get("init");
  const std::vector<std::pair<std::string, ConfigNode>> entries{
      {"type", init.get("from")}, {"file", init.get("file")}, {"number", init.get("frame")}};
  const ConfigNode map = ConfigNode::map_of(entries);
  EXPECT_THAT(map.keys(), ElementsAre("type", "number"));
  EXPECT_EQ(map.get("type").scalar(), "pso");
  EXPECT_EQ(map.get("number").where(), "scene.yaml:3:10");
  EXPECT_EQ(map.where(), "scene.yaml:2:9");
  EXPECT_EQ(map.get("type").path(), "init.from.type");
  EXPECT_EQ(ConfigNode::map_of({}).size(), 0u);
}

TEST(ConfigNode, PositionsCountFromOneAsEditorsDo) {
  const ConfigNode root =
      parse("models:\n  - type: hand\n    name: 'left'\ntracker: {tile: 128}\n");
  EXPECT_EQ(root.get("models").at(0).get("type").where(), "scene.yaml:2:11");
  EXPECT_EQ(root.get("models").at(0).where_key("name"), "scene.yaml:3:5");
  EXPECT_EQ(root.get("models").at(0).get("name").where(), "scene.yaml:3:11");
  EXPECT_EQ(root.get("tracker").where(), "scene.yaml:4:10");
  EXPECT_EQ(root.get("tracker").get("tile").where(), "scene.yaml:4:17");
}

TEST(ConfigNode, ColumnsCountCharactersNotBytes) {
  const ConfigNode root = parse("{größe: 1, b: 2}");
  EXPECT_EQ(root.get("b").where(), "scene.yaml:1:15");
  EXPECT_EQ(parse("\xEF\xBB\xBF{a: 1}").get("a").where(), "scene.yaml:1:5");
}

TEST(ConfigNode, ValueThatIsNotThereIsWhereItsKeyIs) {
  EXPECT_EQ(parse("a: 1\nempty:\nb: 2\n").get("empty").where(), "scene.yaml:2:1");
}

TEST(ConfigNode, MissingNodePointsAtItsParent) {
  const ConfigNode tracker = parse("a: 1\ntracker:\n  tile: 128\n").get("tracker");
  const ConfigNode missing = tracker.get("padding");
  EXPECT_FALSE(missing.defined());
  EXPECT_EQ(missing.where(), "scene.yaml:3:3");
  EXPECT_EQ(missing.where(), tracker.where());
  EXPECT_EQ(missing.path(), "tracker.padding");
  EXPECT_EQ(tracker.get("tile").at(2).path(), "tracker.tile.2");
}

TEST(ConfigNode, PathLeadsFromTheRoot) {
  const ConfigNode root = parse("models: [{a: 1}, {b: {c: 2}}]");
  EXPECT_EQ(root.path(), "");
  EXPECT_EQ(root.get("models").at(1).get("b").get("c").path(), "models.1.b.c");
}

TEST(ConfigNode, NodesOutliveTheRoot) {
  ConfigNode inner;
  { inner = parse("a: {b: [1, 2, 3]}").get("a").get("b"); }
  EXPECT_EQ(inner.at(2).scalar(), "3");
  EXPECT_EQ(inner.path(), "a.b");
}

TEST(ConfigNode, FileKnowsItsFolder) {
  const test::TemporaryDirectory folder;
  std::ofstream(folder.path() / "scene.yaml") << "a: 1\n";
  const ConfigNode root = ConfigNode::load(folder.path() / "scene.yaml");
  EXPECT_EQ(root.directory(), folder.path());
  EXPECT_EQ(root.get("a").where(), (folder.path() / "scene.yaml:1:4").string());
  EXPECT_EQ(parse("a: 1").directory(), std::filesystem::current_path());
}

TEST(ConfigNode, UnreadableFilesAreNamed) {
  const test::TemporaryDirectory folder;
  const auto absent = folder.path() / "absent.yaml";
  EXPECT_EQ(message_of<ConfigError>([&] { ConfigNode::load(absent); }),
            absent.string() + ": cannot be opened: No such file or directory");
  EXPECT_EQ(message_of<ConfigError>([&] { ConfigNode::load(folder.path()); }),
            folder.path().string() + ": is a folder; expected a YAML file");
}

TEST(ConfigNode, BrokenYamlSaysWhere) {
  EXPECT_THAT(parse_error("a: [1, 2\nb: 3\n"), StartsWith("scene.yaml:2:2: broken YAML: "));
  EXPECT_EQ(parse_error("b: 1\na: 'open\n"),
            "scene.yaml:2:4: broken YAML: the quote that begins here is never closed");
  EXPECT_NO_THROW(parse("a: 'it''s'\nb: \"\\\"\"\n"));
  EXPECT_THAT(parse_error("a: b: c\n"), StartsWith("scene.yaml:1:5: broken YAML: "));
  EXPECT_THAT(parse_error("a:\n\tb: 1\n"),
              EndsWith("; this line is indented with a tab, YAML takes "
                       "spaces only"));
}

TEST(ConfigNode, DuplicateKeysAreRefusedWithBothLines) {
  EXPECT_EQ(parse_error("a: 1\nb: 2\na: 3\n"),
            "scene.yaml:3:1: duplicate key 'a'; it was first given in line 1");
  EXPECT_EQ(parse_error("x: {k: 1, k: 2}\n"),
            "scene.yaml:1:11: duplicate key 'k'; it was first given in line 1");
  EXPECT_NO_THROW(parse("x: {k: 1}\ny: {k: 2}\n"));
}

TEST(ConfigNode, AnchorsAliasesAndMergeKeysAreRefused) {
  EXPECT_EQ(parse_error("a: &base 1\nb: *base\n"),
            "scene.yaml:1:4: anchor '&base': anchors are not supported; repeat the value");
  EXPECT_THAT(parse_error("a: 1\nb: *base\n"), StartsWith("scene.yaml:2:"));
  EXPECT_EQ(parse_error("a: 1\n<<: {b: 2}\n"),
            "scene.yaml:2:1: merge keys (<<) are not supported; repeat the values");
}

TEST(ConfigNode, TagsAreRefused) {
  EXPECT_THAT(parse_error("a: !!float 1\n"), AllOf(StartsWith("scene.yaml:1:4: tag "),
                                                   EndsWith("tags are not supported; remove it")));
  EXPECT_THAT(parse_error("a: !mine {b: 1}\n"), HasSubstr("tag '!mine'"));
}

TEST(ConfigNode, OnlyOneDocument) {
  const std::string problem =
      "something follows the end of the document; expected one YAML document per file";
  EXPECT_THAT(parse_error("a: 1\n---\nb: 2\n"), EndsWith(problem));
  EXPECT_THAT(parse_error("a: 1\n---\n"), EndsWith(problem));
  EXPECT_NO_THROW(parse("%YAML 1.2\n---\na: 1\n...\n"));
}

TEST(ConfigNode, KeysAreWords) {
  EXPECT_EQ(parse_error("? [a, b]\n: 1\n"),
            "scene.yaml:1:3: a map or list cannot be a key; expected a word");
  EXPECT_EQ(parse_error("~: 1\n"), "scene.yaml:1:1: null cannot be a key; expected a word");
}

TEST(ConfigNode, TextReadsBackToTheSameNode) {
  const std::string text =
      "a: 1.50\n"
      "b: \"1.50\"\n"
      "c: [1, two, \"true\", true, ~, \"\"]\n"
      "d:\n  - e: \"a: b # c\"\n    f: []\n  - {}\n"
      "g: \"line\\nbreak\\ttab \\\"quoted\\\" größe\"\n"
      "\"odd key: -\": -\n"
      "\"true\": - \n"
      "h: | \n  block\n  text\n";
  const std::string once = parse("x: " + std::string("{a: -x, b: a b}")).to_yaml();
  EXPECT_EQ(parse(once).to_yaml(), once);
  const ConfigNode first = parse(text.substr(0, text.find("\"odd")) + "h: |\n  block\n  text\n");
  const ConfigNode second = parse(first.to_yaml());
  EXPECT_EQ(second.to_yaml(), first.to_yaml());
  EXPECT_TRUE(second.get("a").is_plain());
  EXPECT_FALSE(second.get("b").is_plain());
  EXPECT_EQ(second.get("a").scalar(), "1.50");
  EXPECT_FALSE(second.get("c").at(2).is_plain());
  EXPECT_TRUE(second.get("c").at(4).is_null());
  EXPECT_EQ(second.get("c").at(5).scalar(), "");
  EXPECT_EQ(second.get("d").at(0).get("e").scalar(), "a: b # c");
  EXPECT_TRUE(second.get("d").at(0).get("f").is_list());
  EXPECT_TRUE(second.get("d").at(1).is_map());
  EXPECT_EQ(second.get("g").scalar(), "line\nbreak\ttab \"quoted\" größe");
  EXPECT_EQ(second.get("h").scalar(), "block\ntext\n");
}

TEST(ConfigNode, TextIsBlockStyleWithListsOfScalarsOnOneLine) {
  EXPECT_EQ(parse("{a: {b: 1}, c: [1, 2], d: [{e: 1}, {e: 2}]}").to_yaml(),
            "a:\n  b: 1\nc: [1, 2]\nd:\n  - e: 1\n  - e: 2\n");
}

}  // namespace
}  // namespace hypotrack
