#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <set>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "lab/study/recordings.hpp"
#include "study_test.hpp"

namespace hypotrack::test {
namespace {

using study::Plan;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsSubsetOf;
using testing::SizeIs;

std::vector<std::string> ids(const Plan& plan) {
  std::vector<std::string> ids;
  for (const study::PlannedRun& run : plan.runs) ids.push_back(run.id);
  return ids;
}

class PlanTest : public StudyTest {
 protected:
  /// The ids of the small study with one piece replaced.
  std::vector<std::string> ids_with(const std::string& piece, const std::string& by) const {
    std::string text = small_study();
    return ids(plan(text.replace(text.find(piece), piece.size(), by)));
  }
};

TEST_F(PlanTest, EverySceneMeetsEveryPointOfTheGridWithEverySeed) {
  const Plan plan = this->plan(small_study());
  ASSERT_THAT(plan.cells, SizeIs(8));
  EXPECT_THAT(plan.runs, SizeIs(16));
  EXPECT_EQ(plan.describe(plan.cells[0]), "box, optimizer.particles 8, method pso");
  EXPECT_EQ(plan.describe(plan.cells[1]), "box, optimizer.particles 8, method random");
  EXPECT_EQ(plan.describe(plan.cells[7]), "hand, optimizer.particles 16, method random");
  const auto all = ids(plan);
  EXPECT_THAT(std::set<std::string>(all.begin(), all.end()), SizeIs(16));
  EXPECT_THAT(all[0], testing::MatchesRegex("box_s1_[0-9a-f]{16}"));
}

TEST_F(PlanTest, ChangesApplyInTheOrderStudySceneAxes) {
  const Plan plan = this->plan(small_study());
  std::vector<std::string> changes;
  for (const auto& change : plan.changes_of(plan.cells[1])) changes.push_back(change.assignment());
  EXPECT_THAT(changes, ElementsAre("tile.padding=0.1", "tile.size=32", "optimizer.particles=8",
                                   "optimizer={type: random_search}", "search.angle_deg=20"));
}

TEST_F(PlanTest, AStudyWithoutAGridHasACellPerScene) {
  const Plan plan =
      this->plan("title: t\nscenes: {box: {file: box.yaml}, hand: {file: hand.yaml}}");
  EXPECT_THAT(plan.cells, SizeIs(2));
  EXPECT_THAT(plan.runs, SizeIs(2));
}

TEST_F(PlanTest, AStudyThatGrowsKeepsTheIdsOfItsRuns) {
  const auto before = ids(plan(small_study()));
  EXPECT_THAT(before, IsSubsetOf(ids_with("seeds: 2", "seeds: 5")));
  EXPECT_THAT(before, IsSubsetOf(ids_with("[8, 16]", "[8, 16, 32]")));
  EXPECT_THAT(before, IsSubsetOf(ids_with("  hand:", "  box2: {file: box.yaml}\n  hand:")));
  EXPECT_EQ(before, ids_with("title: Small", "title: Other"));
  EXPECT_EQ(before, ids_with("frames: 5", "frames: 5\noverlay: true"));
}

TEST_F(PlanTest, WhateverDecidesTheResultChangesTheId) {
  const auto before = ids(plan(small_study()));
  const auto differ = [&](const std::vector<std::string>& now) {
    return std::none_of(now.begin(), now.end(), [&](const std::string& id) {
      return std::find(before.begin(), before.end(), id) != before.end();
    });
  };
  EXPECT_TRUE(differ(ids_with("frames: 5", "frames: 6")));
  EXPECT_TRUE(differ(ids_with("tile.padding: 0.1", "tile.padding: 0.2")));
  EXPECT_TRUE(differ(ids_with("[8, 16]", "[9, 17]")));
  EXPECT_TRUE(differ(ids_with("frames: 5", "frames: 5\nrecordings: true")));
  EXPECT_TRUE(differ(ids_with("frames: 5", "frames: 5\ntrace: true")));
  write("box.yaml", "models: [another]\n");
  write("hand.yaml", "models: [another]\n");
  EXPECT_TRUE(differ(ids(plan(small_study()))));
}

TEST_F(PlanTest, WhatIsTakenFromOtherScenesCountsAsIfItWereWrittenThere) {
  write("best.yaml", "seed: 1\noptimizer: {type: pso} # the best\n");
  const auto taken = ids_with("optimizer: {type: pso}", "optimizer: \"@best.yaml\"");
  EXPECT_EQ(taken, ids(plan(small_study())));
  write("best.yaml", "seed: 2\noptimizer: {type: pso}\n");
  EXPECT_EQ(taken, ids_with("optimizer: {type: pso}", "optimizer: \"@best.yaml\""));
  write("best.yaml", "seed: 1\noptimizer: {type: nlopt}\n");
  EXPECT_NE(taken, ids_with("optimizer: {type: pso}", "optimizer: \"@best.yaml\""));
}

TEST_F(PlanTest, TrackersMayBeFilesWhereverTheyLie) {
  write("quick.yaml", "optimizer: {type: pso, particles: 8}\n");
  const auto with = [&](const std::string& name) {
    return ids_with("optimizer: {type: pso}", "tracker: \"" + name + "\"");
  };
  const auto taken = with("@quick.yaml");
  write("trackers/quick.yaml", "optimizer: {type: pso, particles: 8}\n");
  EXPECT_EQ(with("@trackers/quick"), taken);
  write("quick.yaml", "optimizer: {type: pso, particles: 9}\n");
  EXPECT_NE(with("@quick.yaml"), taken);
}

TEST_F(PlanTest, KeysBesideATrackerFileCountWhateverTheirName) {
  write("quick.yaml", "optimizer: {type: pso, particles: 8}\n");
  const auto with = [&](const std::string& key) {
    return ids_with("optimizer: {type: pso}", "tracker: {from: \"@quick.yaml\", " + key + "}");
  };
  EXPECT_NE(with("patience: 3"), with("patience: 4"));
  EXPECT_NE(with("recovery: {tile: 32}"), with("recovery: {tile: 64}"));
}

TEST_F(PlanTest, WhatSceneFilesTakeFromOthersCounts) {
  write("best.yaml", "seed: 1\noptimizer: {type: pso}\n");
  write("box.yaml", "models: []\noptimizer: \"@best.yaml\"\n");
  const Plan before = plan(small_study());
  write("best.yaml", "seed: 2\noptimizer: {type: pso}\n");
  EXPECT_EQ(ids(plan(small_study())), ids(before));
  write("best.yaml", "seed: 1\noptimizer: {type: nlopt}\n");
  const Plan after = plan(small_study());
  EXPECT_NE(after.runs.front().id, before.runs.front().id);  // box
  EXPECT_EQ(after.runs.back().id, before.runs.back().id);    // hand
  EXPECT_NE(recording_id(after, after.runs[0]), recording_id(before, before.runs[0]));
}

TEST_F(PlanTest, ScenesWhosePartsAreNotThereAreRefusedWithTheirPlace) {
  write("box.yaml", "models: []\noptimizer: \"@best.yaml\"\n");
  const std::string complaint = message_of<ConfigError>([&] { plan(small_study()); });
  EXPECT_THAT(complaint, HasSubstr("study.yaml:4:3: box: "));
  EXPECT_THAT(complaint, HasSubstr("box.yaml:2:12: '@best.yaml' cannot be included"));
}

TEST_F(PlanTest, IdsDoNotDependOnWhereTheStudyLies) {
  const auto before = ids(plan(small_study()));
  std::filesystem::create_directory(path("elsewhere"));
  for (const char* name : {"box.yaml", "hand.yaml", "study.yaml"})
    std::filesystem::copy(path(name), path(std::string("elsewhere/") + name));
  EXPECT_EQ(ids(make_plan(study::load_study(path("elsewhere/study.yaml")))), before);
}

TEST_F(PlanTest, CellsShareTheRecordingOfTheSameModelsAndSource) {
  std::string text = small_study();
  text.replace(text.find("random: {"), 9, "random: {source.frames: 7, ");
  const Plan plan = this->plan(text);
  std::set<std::string> recordings;
  for (const study::PlannedRun& run : plan.runs) recordings.insert(recording_id(plan, run));
  EXPECT_THAT(recordings, SizeIs(4));  // two scenes, with and without the change of the source
  EXPECT_EQ(recording_id(plan, plan.runs[0]), recording_id(plan, plan.runs[2]));
}

/// A study of a rendered scene and of one that reads pictures, in three seeds.
std::string rendered_study() {
  return R"(title: Rendered
scenes:
  drawn: {file: drawn.yaml}
  read: {file: hand.yaml, set: {source: {type: image_sequence}}}
grid: {optimizer.particles: [8, 16]}
seeds: 3
)";
}

class RedrawTest : public PlanTest {
 protected:
  RedrawTest() {
    write("drawn.yaml", "models: []\nsource: {type: synthetic, sensor: {seed: 7}}\n");
  }

  /// What the runs of the first scene redraw, by seed.
  std::vector<std::string> redrawn(const std::string& text) const {
    const Plan plan = this->plan(text);
    std::vector<std::string> all;
    for (const study::PlannedRun& run : plan.runs)
      if (run.cell == 0) all.push_back(plan.changes_of(run).back().assignment());
    return all;
  }

  static std::string with(const std::string& piece, const std::string& by) {
    std::string text = rendered_study();
    return text.replace(text.find(piece), piece.size(), by);
  }
};

TEST_F(RedrawTest, SeedsAfterTheFirstRedrawTheNoiseOfRenderedPictures) {
  EXPECT_THAT(redrawn(rendered_study()),
              ElementsAre("optimizer.particles=8", "source.sensor.seed=8", "source.sensor.seed=9"));
  EXPECT_THAT(redrawn(with("seeds: 3", "seeds: [9223372036854775807, 0]")),
              ElementsAre("source.sensor.seed=5", "source.sensor.seed=6"));
}

TEST_F(RedrawTest, TheSeedOfTheNoiseIsThatOfTheChangedScene) {
  const auto changed = [&](const std::string& set) {
    return redrawn(with("{file: drawn.yaml}", "{file: drawn.yaml, set: " + set + "}"))[1];
  };
  EXPECT_EQ(changed("{source.sensor.seed: 3}"), "source.sensor.seed=4");
  EXPECT_EQ(changed("{source.sensor: {noise_sigma: 2}}"), "source.sensor.seed=2");
  EXPECT_EQ(changed("{source: {type: depth_from_stereo, source: \"@source\"}}"),
            "source.source.sensor.seed=8");
}

TEST_F(RedrawTest, EverySettingOfASeedReadsTheSameRecording) {
  const Plan plan = this->plan(rendered_study());
  std::map<std::pair<std::size_t, std::int64_t>, std::set<std::string>> recordings;
  std::set<std::string> all;
  for (const study::PlannedRun& run : plan.runs) {
    const std::string id = recording_id(plan, run);
    recordings[{plan.cells[run.cell].scene, run.seed}].insert(id);
    all.insert(id);
  }
  for (const auto& [place, names] : recordings) EXPECT_THAT(names, SizeIs(1));
  EXPECT_THAT(all, SizeIs(3 + 1));  // rendered in each seed, read in all
}

TEST_F(RedrawTest, RunsWhosePicturesStayTheSameKeepTheirIds) {
  const Plan once = plan(rendered_study() + "redraw: nothing\n");
  const Plan anew = plan(rendered_study());
  for (std::size_t i = 0; i < anew.runs.size(); ++i) {
    const bool drawn_again = anew.cells[anew.runs[i].cell].scene == 0 && anew.runs[i].seed > 1;
    EXPECT_EQ(anew.runs[i].id != once.runs[i].id, drawn_again) << i;
  }
}

TEST_F(PlanTest, ShardsShareOutTheRunsAndTheCells) {
  const Plan plan = this->plan(small_study());
  std::vector<std::size_t> all;
  for (std::size_t shard = 0; shard < 3; ++shard) {
    const auto part = runs_of(plan, {shard, 3});
    EXPECT_THAT(part.size(), testing::AllOf(testing::Ge(4U), testing::Le(6U)));
    all.insert(all.end(), part.begin(), part.end());
  }
  std::sort(all.begin(), all.end());
  std::vector<std::size_t> expected(plan.runs.size());
  for (std::size_t i = 0; i < expected.size(); ++i) expected[i] = i;
  EXPECT_EQ(all, expected);
  // With as many shards as cells, no shard gets one cell with all its seeds.
  const auto part = runs_of(plan, {0, 8});
  ASSERT_THAT(part, SizeIs(2));
  EXPECT_NE(plan.runs[part[0]].cell, plan.runs[part[1]].cell);
}

TEST_F(PlanTest, AStudyOfTooManyRunsIsRefused) {
  std::string text = small_study();
  text.replace(text.find("seeds: 2"), 8, "seeds: 10000");
  text.replace(text.find("[8, 16]"), 7, "[1, 2, 3, 4, 5, 6, 7, 8]");
  EXPECT_THAT(message_of<ConfigError>([&] { plan(text); }),
              HasSubstr("the study 'Small' has more than 100000 runs"));
}

}  // namespace
}  // namespace hypotrack::test
