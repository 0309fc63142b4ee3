#include "scene_folder.hpp"

namespace hypotrack {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// Scenes that include parts of `demo/demo.yaml`.
class Includes : public test::SceneFolder {
 protected:
  Includes() {
    write("demo/demo.yaml",
          "source: {type: images, left: left.png, \"pattern\": \"@left\"}\n"
          "objective: [{type: colors, weight: 2}, {type: skin}]\n"
          "optimizer:\n  type: pipeline\n  stages: [{type: pso}, {type: nlopt}]\n");
  }
  std::string at(const std::string& name, const std::string& position) const {
    return file(name).string() + ":" + position + ": ";
  }
  ConfigNode demo() const { return ConfigNode::load(file("demo/demo.yaml")); }
};

TEST_F(Includes, AreWhatTheOtherSceneHasAtTheSamePlace) {
  const ConfigNode root =
      load("seed: 1\noptimizer: \"@demo/demo.yaml\"\nsource: {left: '@demo/demo.yaml'}\n");
  EXPECT_EQ(root.get("optimizer").to_yaml(), demo().get("optimizer").to_yaml());
  EXPECT_EQ(root.get("source").to_yaml(), "left: left.png\n");
  EXPECT_EQ(root.get("optimizer").get("stages").at(1).get("type").path(),
            "optimizer.stages.1.type");
}

TEST_F(Includes, AreWhatTheOtherSceneHasAtAKeyPath) {
  const ConfigNode root = load(
      "objective: [{type: motion}, \"@demo/demo.yaml#objective.1\"]\n"
      "optimizer: \"@demo/demo.yaml#optimizer.stages.0\"\n");
  EXPECT_EQ(root.get("objective").to_yaml(), "- type: motion\n- type: skin\n");
  EXPECT_EQ(root.get("optimizer").to_yaml(), "type: pso\n");
}

TEST_F(Includes, RememberWhereTheyWereWrittenAndReferToThatFolder) {
  const ConfigNode source = load("source: \"@demo/demo.yaml\"").get("source");
  EXPECT_EQ(source.get("left").where(), file("demo/demo.yaml").string() + ":1:30");
  EXPECT_EQ(source.get("left").directory(), file("demo"));
}

TEST_F(Includes, MayIncludeOthers) {
  write("demo/best.yaml", "optimizer: \"@demo.yaml\"\nobjective: [\"@demo.yaml\"]\n");
  const ConfigNode root =
      load("optimizer: \"@demo/best.yaml\"\nobjective: \"@demo/best.yaml#objective.0\"\n");
  EXPECT_EQ(root.get("optimizer").to_yaml(), demo().get("optimizer").to_yaml());
  EXPECT_EQ(root.get("objective").to_yaml(), demo().get("objective").at(0).to_yaml());
}

TEST_F(Includes, CanBeChangedByOverrides) {
  const ConfigNode root =
      load("optimizer: \"@demo/demo.yaml\"", {"optimizer.stages.1.type=cma_es"});
  EXPECT_EQ(root.get("optimizer").get("stages").at(1).get("type").scalar(), "cma_es");
}

TEST_F(Includes, CanBeInOverrides) {
  const std::string from = "@" + file("demo/demo.yaml").string();
  const ConfigNode root =
      load("objective: {type: colors}\nmodels: []\n",
           {"optimizer=" + from, "objective=[\"" + from + "#objective.1\", \"@objective\"]",
            "source.left=" + from, "optimizer.stages.2=" + from + "#optimizer.stages.0"});
  EXPECT_EQ(root.get("optimizer").get("stages").size(), 3u);
  EXPECT_EQ(root.get("objective").to_yaml(), "- type: skin\n- type: colors\n");
  EXPECT_EQ(root.get("source").get("left").scalar(), "left.png");
}

TEST_F(Includes, OfAnOverrideReferToTheWorkingDirectory) {
  EXPECT_THAT(
      error("seed: 1", {"optimizer=@nowhere.yaml"}),
      AllOf(StartsWith("--set optimizer=@nowhere.yaml: '@nowhere.yaml' cannot be included: "),
            HasSubstr((std::filesystem::current_path() / "nowhere.yaml").string())));
}

TEST_F(Includes, AreAsTheyWereWritten) {
  const std::string from = "@" + file("demo/demo.yaml").string();
  EXPECT_EQ(load("seed: 1", {"source=" + from}).get("source").get("pattern").scalar(), "@left");
  const ConfigNode root = load("name: \"@left\"\nother: \"@@demo/demo.yaml\"", {"a=@@b.yaml"});
  EXPECT_EQ(root.get("name").scalar(), "@left");
  EXPECT_EQ(root.get("other").scalar(), "@@demo/demo.yaml");
  EXPECT_EQ(root.get("a").scalar(), "@b.yaml");
}

TEST_F(Includes, ThatAreNotThereAreRefusedWithWhatIs) {
  EXPECT_EQ(error("seed: 1\noptimiser: \"@demo/demo.yaml\""),
            at("scene.yaml", "2:12") +
                "'@demo/demo.yaml' cannot be included: " + file("demo/demo.yaml").string() +
                " has nothing at 'optimiser'; expected a key path in it, after a "
                "#; it is a map of source, objective, optimizer; did you mean 'optimizer'?");
  EXPECT_THAT(error("a: \"@demo/demo.yaml#objective.2.type\""),
              EndsWith("its 'objective' is a list of 2"));
  EXPECT_THAT(error("a: \"@demo/demo.yaml#source.left.x\""),
              EndsWith("its 'source.left' is a value without keys"));
  EXPECT_THAT(error("a: \"@demo/demo.yaml#\""), HasSubstr("has nothing at ''"));
}

TEST_F(Includes, OfFilesThatCannotBeReadAreRefused) {
  EXPECT_EQ(error("a: \"@none.yaml\""),
            at("scene.yaml", "1:4") + "'@none.yaml' cannot be included: " +
                file("none.yaml").string() + ": cannot be opened: No such file or directory");
  write("broken.yaml", "seed: 1\na: [1\n");
  EXPECT_THAT(error("a: [1, \"@broken.yaml\"]"),
              AllOf(StartsWith(at("scene.yaml", "1:8")),
                    HasSubstr(at("broken.yaml", "3:1") + "broken YAML")));
  write("folder.yaml/x", "");
  EXPECT_THAT(error("a: \"@folder.yaml\""), EndsWith("is a folder; expected a YAML file"));
  EXPECT_THAT(error("a: \"@" + std::string(5000, 'x') + ".yaml\""), HasSubstr("cannot be opened"));
}

TEST_F(Includes, NeedQuotesWhereTheyAreNotTheWholeOfAnOverride) {
  const std::string hint = "broken YAML: unknown token; a text that begins with @ needs quotes";
  EXPECT_EQ(error("optimizer: @demo/demo.yaml"), at("scene.yaml", "1:12") + hint);
  EXPECT_EQ(error("a: 1", {"b=[@demo.yaml]"}), "--set b=[@demo.yaml]: " + hint);
}

TEST_F(Includes, InACircleAreRefused) {
  write("other.yaml", "b: 1\na:\n  c: \"@scene.yaml#b\"\n");
  EXPECT_EQ(error("a: 1\nb: \"@other.yaml\"\n"),
            at("scene.yaml", "2:4") +
                "'@other.yaml' cannot be included: " + at("other.yaml", "3:6") +
                "'@scene.yaml#b' cannot be included: " + file("scene.yaml").string() +
                " includes this file itself; write out one of the two");
  EXPECT_THAT(error("a: \"@scene.yaml#b\"\nb: 1\n"), HasSubstr("includes this file itself"));
  std::filesystem::create_symlink(".", file("here"));
  EXPECT_THAT(error("a: \"@here/scene.yaml#b\"\nb: 1\n"), HasSubstr("includes this file itself"));
}

TEST_F(Includes, CannotNestDeeperThanFiles) {
  std::string deep = "1";
  for (int i = 0; i < 40; ++i) deep = "[" + deep + "]";
  write("deep.yaml", "a: " + deep);
  std::string deeper = "\"@deep.yaml#a\"";
  for (int i = 0; i < 40; ++i) deeper = "[" + deeper + "]";
  EXPECT_THAT(error("b: " + deeper), EndsWith("nested deeper than 64 levels"));
}

TEST_F(Includes, CannotHoldMoreValuesThanFiles) {
  std::string text = "x: [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
  for (int level = 0; level < 8; ++level) {
    const std::string name = "level" + std::to_string(level) + ".yaml";
    write(name, text);
    text = "x: [";
    for (int i = 0; i < 10; ++i) text += "\"@" + name + "#x\", ";
    text += "]\n";
  }
  EXPECT_THAT(error(text), EndsWith("more than 1000000 values are included"));
}

}  // namespace
}  // namespace hypotrack
