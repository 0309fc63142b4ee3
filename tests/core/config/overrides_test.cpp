#include <fstream>

#include "expect_error.hpp"
#include "hypotrack/api/config.hpp"
#include "hypotrack/api/error.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

using test::message_of;
using ::testing::EndsWith;
using ::testing::StartsWith;

class Overrides : public ::testing::Test {
 protected:
  ConfigNode load(const std::vector<std::string>& overrides) {
    const auto file = folder_.path() / "scene.yaml";
    std::ofstream(file)
        << "models:\n  - type: hand\n  - type: box\noptimizer: {type: pso}\nnone:\n";
    return ConfigNode::load_scene(file, overrides);
  }
  std::string error(const std::string& assignment) {
    return message_of<ConfigError>([&] { load({assignment}); });
  }

  test::TemporaryDirectory folder_;
};

TEST_F(Overrides, ReplaceValues) {
  const ConfigNode root = load({"models.1.type=cup", "optimizer.type=nlopt"});
  EXPECT_EQ(root.get("models").at(1).get("type").scalar(), "cup");
  EXPECT_EQ(root.get("optimizer").get("type").scalar(), "nlopt");
  EXPECT_EQ(root.get("models").at(0).get("type").scalar(), "hand");
}

TEST_F(Overrides, LaterOnesWin) { EXPECT_EQ(load({"seed=1", "seed=2"}).get("seed").scalar(), "2"); }

TEST_F(Overrides, SayWhereTheyComeFrom) {
  const ConfigNode type = load({"models.0.type=mirrored_hand"}).get("models").at(0).get("type");
  EXPECT_EQ(type.where(), "--set models.0.type=mirrored_hand");
  EXPECT_EQ(type.path(), "models.0.type");
}

TEST_F(Overrides, CreateWhatIsMissing) {
  const ConfigNode root = load({"search.crop.padding=0.2", "lists.0.0=5", "none.a=1"});
  EXPECT_EQ(root.get("search").get("crop").get("padding").scalar(), "0.2");
  EXPECT_EQ(root.get("lists").at(0).at(0).scalar(), "5");
  EXPECT_EQ(root.get("none").get("a").scalar(), "1");
  EXPECT_EQ(root.where_key("search"), "--set search.crop.padding=0.2");
  EXPECT_EQ(root.get("search").get("crop").path(), "search.crop");
}

TEST_F(Overrides, PutWhatTheSceneHasIntoSomethingElse) {
  const ConfigNode root = load({R"(optimizer={type: repeated, of: "@optimizer"})",
                                R"(models=["@models.1", {type: cup}, {type: "@@at"}])"});
  EXPECT_EQ(root.get("optimizer").to_yaml(), "type: repeated\nof:\n  type: pso\n");
  EXPECT_EQ(root.get("optimizer").get("of").get("type").path(), "optimizer.of.type");
  EXPECT_THAT(root.get("optimizer").get("of").where(), EndsWith("scene.yaml:4:12"));
  EXPECT_EQ(root.get("models").at(0).get("type").scalar(), "box");
  EXPECT_EQ(root.get("models").at(2).get("type").scalar(), "@at");
}

TEST_F(Overrides, ReferToWhatIsThere) {
  EXPECT_THAT(error(R"(optimizer={type: repeated, of: "@optimiser"})"),
              ::testing::HasSubstr("'@optimiser' stands for what the scene has at 'optimiser', and "
                                   "there is nothing"));
  EXPECT_THAT(error(R"(seed="@models.7")"), ::testing::HasSubstr("there is nothing"));
}

TEST_F(Overrides, AppendToLists) {
  const ConfigNode root = load({"models.2.type=cup"});
  EXPECT_EQ(root.get("models").size(), 3u);
  EXPECT_EQ(root.get("models").at(2).get("type").path(), "models.2.type");
}

TEST_F(Overrides, ValuesAreYaml) {
  const ConfigNode root = load({"optimizer={type: nlopt, steps: [1, 2]}", "name='a=b'", "empty="});
  EXPECT_EQ(root.get("optimizer").get("steps").at(1).scalar(), "2");
  EXPECT_EQ(root.get("name").scalar(), "a=b");
  EXPECT_FALSE(root.get("name").is_plain());
  EXPECT_TRUE(root.get("empty").is_null());
}

TEST_F(Overrides, PathsAreRelativeToTheWorkingDirectory) {
  const ConfigNode root = load({"mesh=a.obj"});
  EXPECT_EQ(root.get("mesh").directory(), std::filesystem::current_path());
  EXPECT_EQ(root.get("models").directory(), folder_.path());
}

TEST_F(Overrides, ThatDoNotParseAreRefused) {
  const std::string form = ": expected key.path=value, for example optimizer.particles=64";
  for (const auto* text : {"seed", "=1", "a..b=1", ".a=1", "a.=1", ""}) {
    EXPECT_EQ(error(text), "--set " + std::string(text) + form);
  }
  EXPECT_THAT(error("a=[1, 2"), StartsWith("--set a=[1, 2: broken YAML: "));
  EXPECT_THAT(error("a={b: 1, b: 2}"), EndsWith("duplicate key 'b'; it was first given in line 1"));
}

TEST_F(Overrides, MustFitTheFile) {
  EXPECT_EQ(
      error("models.type=hand"),
      "--set models.type=hand: 'type' is no item of the list 'models'; expected an index from "
      "0 to 2 (2 appends)");
  EXPECT_EQ(error("models.5=1"),
            "--set models.5=1: '5' is no item of the list 'models'; expected an index from 0 to 2 "
            "(2 appends)");
  EXPECT_EQ(
      error("optimizer.type.name=1"),
      "--set optimizer.type.name=1: 'optimizer.type' is the value 'pso' and has no key 'name'");
}

TEST_F(Overrides, CannotNestDeeperThanFiles) {
  std::string path = "a";
  for (int i = 0; i < 64; ++i) path += ".a";
  EXPECT_THAT(error(path + "=1"), EndsWith(": nested deeper than 64 levels"));
}

}  // namespace
}  // namespace hypotrack
