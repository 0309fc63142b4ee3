#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene_folder.hpp"

namespace hypotrack {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// Scenes that name the tracker `trackers/quick.yaml` in their folder.
class TrackerFile : public test::SceneFolder {
 protected:
  TrackerFile() {
    write("trackers/quick.yaml",
          "objective: [{type: colors, weight: 2}, {type: skin}]\n"
          "optimizer: {type: pso, particles: 16}\n"
          "budget: {evaluations: 32, seconds: 1}\n"
          "judge: plain\n"
          "status: {history: 40}\n");
  }
};

TEST_F(TrackerFile, GivesASceneAllItsKeys) {
  const ConfigNode root = load("models: []\ntracker: \"@trackers/quick\"\nseed: 1\n");
  EXPECT_EQ(root.get("objective").at(1).get("type").scalar(), "skin");
  EXPECT_EQ(root.get("optimizer").get("particles").scalar(), "16");
  EXPECT_EQ(root.get("status").to_yaml(), "history: 40\n");
  EXPECT_FALSE(root.get("tracker").defined());
  EXPECT_EQ(root.get("judge").scalar(), "plain");
  EXPECT_EQ(root.get("seed").scalar(), "1");
  EXPECT_EQ(root.get("optimizer").where(), file("trackers/quick.yaml").string() + ":2:12");
}

TEST_F(TrackerFile, LeavesTheKeysOfTheSceneAsTheyAre) {
  const ConfigNode root = load(
      "tracker: \"@trackers/quick.yaml\"\nstatus: {patience: 3}\n"
      "budget: {evaluations: 64}\nobjective: {type: skin}\n");
  EXPECT_EQ(root.get("budget").to_yaml(), "evaluations: 64\nseconds: 1\n");
  EXPECT_EQ(root.get("objective").to_yaml(), "type: skin\n");
  EXPECT_EQ(root.get("status").to_yaml(), "patience: 3\nhistory: 40\n");
}

TEST_F(TrackerFile, IsNotMixedWithAPartOfAnotherType) {
  const ConfigNode root =
      load("tracker: \"@trackers/quick\"\noptimizer: {type: nlopt, algorithm: SBPLX}\n");
  EXPECT_EQ(root.get("optimizer").to_yaml(), "type: nlopt\nalgorithm: SBPLX\n");
}

TEST_F(TrackerFile, OfAnOverrideReplacesTheWholeTrackerOfTheScene) {
  const std::string scene =
      "tracker: \"@trackers/other\"\nobjective: {type: other}\nsearch: {position_mm: 9}\n"
      "judge: none\nseed: 1\n";
  const std::string name = "@" + file("trackers/quick").string();
  for (const std::string& value : {name, "\"" + name + "\"", "{from: \"" + name + "\"}"}) {
    const ConfigNode root = load(
        scene, {"tracker=@none", "optimizer.particles=8", "tracker=" + value, "status.patience=3"});
    EXPECT_EQ(root.get("objective").at(0).get("type").scalar(), "colors") << value;
    EXPECT_EQ(root.get("optimizer").get("particles").scalar(), "8") << value;
    EXPECT_FALSE(root.get("search").defined()) << value;
    EXPECT_EQ(root.get("judge").scalar(), "plain") << value;
    EXPECT_EQ(root.get("status").to_yaml(), "history: 40\npatience: 3\n") << value;
    EXPECT_EQ(root.get("seed").scalar(), "1") << value;
  }
}

TEST_F(TrackerFile, MayBeAnotherOneWithChanges) {
  write("trackers/slow.yaml", "tracker: \"@trackers/quick\"\nbudget: {evaluations: 1}\n");
  write("trackers/trackers/quick.yaml", "optimizer: {type: cma_es}\n");
  const ConfigNode root = load("tracker: \"@trackers/slow\"\n");
  EXPECT_EQ(root.get("optimizer").to_yaml(), "type: cma_es\n");
  EXPECT_EQ(root.get("budget").to_yaml(), "evaluations: 1\n");
}

TEST_F(TrackerFile, AndASceneMayNotReferToEachOther) {
  write("trackers/a.yaml", "objective: \"@../scene.yaml\"\n");
  EXPECT_THAT(error("models: []\ntracker: \"@trackers/a\"\n"),
              HasSubstr("includes this file itself"));
  write("trackers/b.yaml", "tracker: \"@c.yaml\"\n");
  write("trackers/c.yaml", "tracker: \"@b.yaml\"\n");
  EXPECT_THAT(error("tracker: \"@trackers/b\"\n"), HasSubstr("includes this file itself"));
}

TEST_F(TrackerFile, ComesWithHypotrackWhereTheSceneHasNone) {
  const ConfigNode root = load("tracker: \"@trackers/real_time\"\n");
  EXPECT_EQ(root.get("optimizer").get("type").scalar(), "levenberg_marquardt");
  EXPECT_EQ(root.get("objective").at(1).get("type").scalar(), "skin");
}

TEST_F(TrackerFile, IsSeenByScenesThatTakePartsOfTheScene) {
  write("demo.yaml", "models: []\ntracker: \"@trackers/quick\"\n");
  const ConfigNode root = load("optimizer: \"@demo.yaml\"\n");
  EXPECT_EQ(root.get("optimizer").get("type").scalar(), "pso");
}

TEST_F(TrackerFile, IsRefusedWithWhatThereIs) {
  EXPECT_THAT(error("tracker: \"@trackers/real_tim\""),
              AllOf(StartsWith(file("scene.yaml").string() +
                               ":1:10: there is no tracker '@trackers/real_tim': " +
                               file("trackers/real_tim.yaml").string() +
                               " is no file; did you mean '@trackers/real_time'? With "),
                    HasSubstr("@trackers/recommended")));
  write("trackers/scene.yaml", "models: []\nsource: {}\n");
  EXPECT_THAT(error("tracker: \"@trackers/scene\""), HasSubstr("is no tracker; expected a map"));
  write("trackers/list.yaml", "[1, 2]\n");
  EXPECT_THAT(error("tracker: \"@trackers/list.yaml\""), HasSubstr("is no tracker"));
  EXPECT_THAT(error("seed: 1", {"tracker=@trackers/none.yaml"}),
              StartsWith("--set tracker=@trackers/none.yaml"));
  EXPECT_THAT(error("tracker: \"@" + std::string(300, 'x') + "\""), HasSubstr("is no file"));
  write("trackers/broken.yaml", "a: [\n");
  EXPECT_THAT(error("tracker: \"@trackers/broken\""),
              StartsWith(file("scene.yaml").string() + ":1:10: the tracker '@trackers/broken'"));
}

}  // namespace
}  // namespace hypotrack
