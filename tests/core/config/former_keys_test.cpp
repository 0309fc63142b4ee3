#include "config/former_keys.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene_folder.hpp"

namespace hypotrack {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class FormerKeys : public test::SceneFolder {
 protected:
  std::vector<std::string> notes_of(const std::string& text,
                                    const std::vector<std::string>& overrides = {}) const {
    write("scene.yaml", text);
    std::vector<std::string> notes;
    (void)ConfigNode::load_scene(file("scene.yaml"), overrides, &notes);
    return notes;
  }
};

std::string migrated(const std::string& text) { return detail::migrate(text, "scene.yaml"); }

TEST_F(FormerKeys, HaveTheirPlaceOfToday) {
  const ConfigNode root = load(
      "tracker: {recovery: {run: frame}, patience: 3, tracked_above: 0.7}\n"
      "recovery: {tile: 32}\nstatus: {history: 9}\n");
  EXPECT_EQ(root.get("recovery").to_yaml(), "tile: 32\nrun: frame\n");
  EXPECT_EQ(root.get("status").to_yaml(), "history: 9\npatience: 3\n");
  EXPECT_EQ(root.get("judge").to_yaml(), "type: network\ntracked_above: 0.7\n");
  EXPECT_FALSE(root.get("tracker").defined());
  EXPECT_THAT(notes_of("seed: 1\ntracker: {patience: 3}\n"),
              testing::ElementsAre(file("scene.yaml").string() +
                                   ":2:10: `tracker.patience` is `status.patience` now; "
                                   "`hypotrack migrate FILE...` rewrites files"));
  EXPECT_THAT(notes_of("status: {patience: 3}\n"), testing::IsEmpty());
}

TEST_F(FormerKeys, OfAnOverrideWinOverTheScene) {
  const ConfigNode root = load("recovery: {tile: 32}\n", {"tracker.recovery.tile=16"});
  EXPECT_EQ(root.get("recovery").get("tile").scalar(), "16");
}

TEST_F(FormerKeys, OfAnOverrideReplaceWhatThoseOfTodayWould) {
  const std::string scene = "recovery: {tile: 32, from: auto}\nstatus: {patience: 4}\n";
  const auto with = [&](const std::vector<std::string>& overrides) {
    return load(scene, overrides);
  };
  EXPECT_EQ(with({"tracker.recovery={run: frame}"}).get("recovery").to_yaml(), "run: frame\n");
  EXPECT_EQ(with({"tracker.recovery.from={type: x}"}).get("recovery").get("from").to_yaml(),
            "type: x\n");
  EXPECT_EQ(with({"tracker.patience=3", "status.patience=5"}).get("status").to_yaml(),
            "patience: 5\n");
  EXPECT_EQ(with({"tracker.patience=@tracker.recovery.tile"}).get("status").to_yaml(),
            "patience: 32\n");
  EXPECT_FALSE(with({"tracker={recovery: {run: frame}}"}).get("status").defined());
  EXPECT_EQ(with({"tracker.evidence=false"}).get("judge").scalar(), "none");
  EXPECT_THAT(notes_of(scene, {"tracker.patience=3"}),
              testing::ElementsAre("--set tracker.patience=3: `tracker.patience` is "
                                   "`status.patience` now"));
}

TEST_F(FormerKeys, OfThresholdsMakeAMapOfTheJudge) {
  const char* const now = "type: network\ntracked_above: 0.7\n";
  for (const char* scene : {"seed: 1\n", "judge: network\n"})
    for (const char* key : {"tracker.tracked_above=0.7", "judge.tracked_above=0.7"})
      EXPECT_EQ(load(scene, {key}).get("judge").to_yaml(), now) << scene << key;
}

TEST_F(FormerKeys, LeadIntoIncludedScenes) {
  write("old.yaml", "tracker: {recovery: {tile: 32}, patience: 3}\n");
  for (const char* scene :
       {"tracker: {recovery: \"@old.yaml\"}\n", "recovery: \"@old.yaml\"\n",
        "recovery: \"@old.yaml#tracker.recovery\"\n", "tracker: \"@old.yaml#tracker\"\n"})
    EXPECT_EQ(load(scene).get("recovery").to_yaml(), "tile: 32\n") << scene;
}

TEST_F(FormerKeys, OfATrackerFileGiveWayToKeysOfTheScene) {
  write("trackers/old.yaml", "tracker: {recovery: {tile: 32, run: frame}}\n");
  const ConfigNode root = load("tracker: \"@trackers/old\"\nrecovery: {tile: 16}\n");
  EXPECT_EQ(root.get("recovery").to_yaml(), "tile: 16\nrun: frame\n");
  EXPECT_THAT(notes_of("tracker: {from: \"@trackers/old\"}\n").front(),
              HasSubstr("old.yaml:1:10: `tracker.recovery` is `recovery` now"));
}

TEST_F(FormerKeys, ThatNeverWereAreRefusedWithTheirPlace) {
  EXPECT_THAT(error("tracker:\n  patence: 3\n"),
              AllOf(HasSubstr("scene.yaml:2:3: found the key 'patence' in `tracker`"),
                    HasSubstr("did you mean 'patience'?"), HasSubstr("\"@trackers/NAME\"")));
}

/// Text with a former key, the same with that of today, and both keys as a note tells them.
struct Renamed {
  const char *former, *today, *note;
};
constexpr Renamed kRenamed[] = {
    {"search: {second_look: 0.2}\n", "search: {second_search: 0.2}\n",
     "`second_look` is `second_search` now"},
    {"recovery: {first_starts: 2}\n", "recovery: {first_restarts: 2}\n",
     "`first_starts` is `first_restarts` now"},
    {"judge: {type: network, surely_above: 0.5}\n", "judge: {type: network, certain_above: 0.5}\n",
     "`surely_above` is `certain_above` now"},
    {"objective:\n  - {type: edges, charge: 1}\n  - {type: stereo_color, charge: 0.1}  # why\n",
     "objective:\n  - {type: edges, charge: 1}\n  - {type: stereo_color, coverage_penalty: 0.1}  # "
     "why\n",
     "`charge` is `coverage_penalty` now"},
    {"optimizer: {type: multi_start, starts: 3, optimizer: {type: pso, starts: 1}}\n",
     "optimizer: {type: multi_start, restarts: 3, optimizer: {type: pso, starts: 1}}\n",
     "`starts` is `restarts` now"},
    {"optimizer: {type: levenberg_marquardt, \"starts\": 3}\n",
     "optimizer: {type: levenberg_marquardt, \"restarts\": 3}\n", "`starts` is `restarts` now"},
    {"optimizer:\n  type: pipeline\n  stages:\n    - optimizer: {type: pso, rescue: 1}\n      "
     "rescue: true\n",
     "optimizer:\n  type: pipeline\n  stages:\n    - optimizer: {type: pso, rescue: 1}\n      "
     "fallback: true\n",
     "`rescue` is `fallback` now"},
    {"shape: {from: starts}\n", "shape: {from: starters}\n", "`starts` is `starters` now"}};

TEST_F(FormerKeys, HaveTheirNameOfToday) {
  for (const auto& [former, today, note] : kRenamed) {
    EXPECT_EQ(load(former).to_yaml(), load(today).to_yaml()) << former;
    EXPECT_THAT(notes_of(former), testing::ElementsAre(HasSubstr(note))) << former;
    EXPECT_THAT(notes_of(today), testing::IsEmpty()) << today;
  }
}

TEST_F(FormerKeys, ThatHaveAnotherNameWinInAnOverride) {
  const std::string scene =
      "search: {second_search: 0.3}\nobjective: {type: stereo_color, coverage_penalty: 0.3}\n";
  const ConfigNode root = load(scene, {"objective.charge=0.1", "search.second_look=0.2"});
  EXPECT_EQ(root.get("objective").to_yaml(), "type: stereo_color\ncoverage_penalty: 0.1\n");
  EXPECT_EQ(root.get("search").to_yaml(), "second_search: 0.2\n");
  EXPECT_EQ(load("tracker: {surely_above: 0.5}\n").get("judge").to_yaml(),
            "type: network\ncertain_above: 0.5\n");
}

TEST(Migrate, RenamesKeys) {
  for (const auto& [former, today, note] : kRenamed) EXPECT_EQ(migrated(former), today);
  EXPECT_EQ(migrated("tracker: {surely_above: 0.5, recovery: {first_starts: 2}}\n"),
            "recovery: {first_restarts: 2}\njudge: {type: network, certain_above: 0.5}\n");
  EXPECT_EQ(
      migrated("grid: {search.second_look: [0]}\nscenes: {a: {set: {judge.surely_above: 1}}}\n"),
      "grid: {search.second_search: [0]}\nscenes: {a: {set: {judge.certain_above: 1}}}\n");
}

TEST(Migrate, RewritesMapsInBraces) {
  EXPECT_EQ(
      migrated("tracker: {from: \"@trackers/real\", recovery: {run: frame}, patience: 3}  # x\n"),
      "tracker: \"@trackers/real\"\nrecovery: {run: frame}\nstatus: {patience: 3}  # x\n");
  EXPECT_EQ(migrated("{seed: 1, tracker: {evidence: false, history: 9}}"),
            "{seed: 1, judge: none, status: {history: 9}}");
}

TEST(Migrate, RewritesLinesWithTheirComments) {
  EXPECT_EQ(migrated("# a\n"
                     "tracker:  # b\n"
                     "  patience: 3\n"
                     "  # c\n"
                     "  recovery:\n"
                     "    run: frame  # d\n"
                     "\n"
                     "  tracked_above: 0.7\n"
                     "# e\n"
                     "seed: 1\n"),
            "# a\n"
            "# b\n"
            "# c\n"
            "recovery:\n"
            "  run: frame  # d\n"
            "judge:\n"
            "  type: network\n"
            "\n"
            "  tracked_above: 0.7\n"
            "status:\n"
            "  patience: 3\n"
            "# e\n"
            "seed: 1\n");
}

TEST(Migrate, RewritesPathsOfStudies) {
  EXPECT_EQ(migrated("scenes:\n"
                     "  a: {file: a.yaml, set: {tracker.recovery.run: frame}}\n"
                     "grid: {\"tracker.uncertainty.enabled\": [true]}\n"
                     "plots: [{x: tracker.uncertainty.enabled}]\n"),
            "scenes:\n"
            "  a: {file: a.yaml, set: {recovery.run: frame}}\n"
            "grid: {\"uncertainty.enabled\": [true]}\n"
            "plots: [{x: uncertainty.enabled}]\n");
}

TEST(Migrate, KeepsTheMarkOfUtf8AndTheEndsOfLines) {
  EXPECT_EQ(migrated("\xEF\xBB\xBFtracker: {patience: 3}\r\nseed: 1\r\n"),
            "\xEF\xBB\xBFstatus: {patience: 3}\r\nseed: 1\r\n");
  EXPECT_EQ(migrated("tracker:\r\n  patience: 3\r\n  recovery: {tile: 32}\r\n"),
            "recovery: {tile: 32}\r\nstatus:\r\n  patience: 3\r\n");
}

TEST(Migrate, LeavesOtherTextsAsTheyAre) {
  for (const char* text :
       {"tracker: \"@trackers/real\"\n", "grid: {tracker: {fast: {seed: 2}}}\n", "", "seed: 1"})
    EXPECT_EQ(migrated(text), text);
}

TEST(Migrate, LeavesToPeopleWhatItCannotRewrite) {
  for (const char* text :
       {"status: {history: 9}\ntracker: {patience: 3}\n",
        "tracker: {patience: 3,  # why\n  history: 9}\n",
        "scenes: {a: {set: {tracker: {patience: 3}}}}\n", "{seed: 1, tracker: {evidence: true}}\n"})
    EXPECT_THAT(test::message_of<ConfigError>([&] { migrated(text); }),
                AllOf(HasSubstr("scene.yaml:"), HasSubstr("rewrite `tracker` yourself")));
}

}  // namespace
}  // namespace hypotrack
