#include <gmock/gmock.h>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "study_test.hpp"

namespace hypotrack::test {
namespace {

using study::Axis;
using study::Change;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

std::vector<std::string> assignments(const std::vector<Change>& changes) {
  std::vector<std::string> texts;
  for (const Change& change : changes) texts.push_back(change.assignment());
  return texts;
}

std::vector<std::string> labels(const Axis& axis) {
  std::vector<std::string> texts;
  for (const study::Choice& choice : axis.choices) texts.push_back(choice.label);
  return texts;
}

class StudyFileTest : public StudyTest {
 protected:
  /// What is said about the small study with one piece replaced.
  std::string complaint(const std::string& piece, const std::string& by,
                        const std::optional<std::string>& variant = std::nullopt) const {
    std::string text = small_study();
    const auto at = text.find(piece);
    EXPECT_NE(at, std::string::npos) << piece;
    return message_of<ConfigError>([&] { load(text.replace(at, piece.size(), by), variant); });
  }
};

TEST_F(StudyFileTest, ScenesHaveTheStudysChangesThenTheirOwn) {
  const study::Study study = load(small_study());
  ASSERT_EQ(study.scenes.size(), 2U);
  EXPECT_EQ(study.scenes[0].file, path("box.yaml"));
  EXPECT_EQ(study.scenes[0].label, "A box");
  EXPECT_EQ(study.scenes[1].label, "hand");
  EXPECT_THAT(assignments(study.scenes[0].changes),
              ElementsAre("tile.padding=0.1", "tile.size=32"));
  EXPECT_THAT(
      assignments(study.scenes[1].changes),
      ElementsAre("tile.size=64", "tile.padding=0.1", "objective={type: stereo_color, window: 3}"));
}

TEST_F(StudyFileTest, ScenesMayBeThoseOfHypotrack) {
  std::string text = small_study();
  text.replace(text.find("box.yaml"), 8, "\"@scenes/demo\"");
  const study::Study study = load(text);
  EXPECT_EQ(study.scenes[0].file.filename(), "demo.yaml");
  EXPECT_TRUE(std::filesystem::is_regular_file(study.scenes[0].file));
}

TEST_F(StudyFileTest, AxesAreValuesOfAKeyOrNamedCases) {
  const study::Study study = load(small_study());
  ASSERT_EQ(study.axes.size(), 2U);
  EXPECT_TRUE(study.axes[0].is_key);
  EXPECT_TRUE(study.axes[0].choices[0].is_number);
  EXPECT_THAT(labels(study.axes[0]), ElementsAre("8", "16"));
  EXPECT_FALSE(study.axes[1].is_key);
  EXPECT_THAT(labels(study.axes[1]), ElementsAre("pso", "random"));
  EXPECT_THAT(assignments(study.axes[1].choices[1].changes),
              ElementsAre("optimizer={type: random_search}", "search.angle_deg=20"));
}

TEST_F(StudyFileTest, SeedsAreACountOrAList) {
  EXPECT_THAT(load(small_study()).seeds, ElementsAre(1, 2));
  EXPECT_THAT(load(small_study(), "quick").seeds, ElementsAre(7));
}

/// Loads a study that adds to the small one, which stands in another folder as base/study.yaml.
class ExtendedStudyTest : public StudyFileTest {
 protected:
  ExtendedStudyTest() {
    for (const char* name : {"base/box.yaml", "base/hand.yaml"}) write(name, "models: []\n");
    write("base/study.yaml", small_study());
  }
  study::Study load_more(const std::string& more,
                         const std::optional<std::string>& variant = std::nullopt) const {
    return load("extends: \"@base/study.yaml\"\n" + more, variant);
  }
  std::string complaint_about(const std::string& text) const {
    return message_of<ConfigError>([&] { load(text); });
  }
};

TEST_F(ExtendedStudyTest, IsTheOtherWhereItSaysNothing) {
  const study::Study same = load_more("");
  EXPECT_EQ(to_yaml(same), to_yaml(study::load_study(path("base/study.yaml"))));
  EXPECT_EQ(same.directory, path("base"));
}

TEST_F(ExtendedStudyTest, AddsCasesScenesAndVariants) {
  const study::Study more = load_more(
      "title: Mine\n"
      "scenes: {small: {file: box.yaml}}\n"
      "grid: {method: {mine: {optimizer: {type: mine}}, pso: {optimizer: {type: cma_es}}}}\n"
      "variants: {one: {frames: 2}}\n",
      "one");
  EXPECT_EQ(more.title, "Mine");
  EXPECT_THAT(labels(more.axes[1]), ElementsAre("pso", "random", "mine"));
  EXPECT_THAT(assignments(more.axes[1].choices[0].changes),
              ElementsAre("optimizer={type: cma_es}"));
  EXPECT_EQ(more.frames, 2);
  ASSERT_EQ(more.scenes.size(), 1U) << "the scenes of the other's variant `one`";
  const study::Study all = load_more("scenes: {small: {file: box.yaml}}\n");
  ASSERT_EQ(all.scenes.size(), 3U);
  EXPECT_EQ(all.scenes[2].file, path("box.yaml"))
      << "paths of scenes refer to the file they are in";
}

TEST_F(ExtendedStudyTest, ReplacesListsAndNumbers) {
  const study::Study more = load_more("seeds: 4\ngrid: {optimizer.particles: [5]}\nplots: []\n");
  EXPECT_EQ(more.seeds.size(), 4U);
  EXPECT_THAT(labels(more.axes[0]), ElementsAre("5"));
  EXPECT_TRUE(more.plots.empty());
}

TEST_F(ExtendedStudyTest, FindsTheStudiesThatComeWithTheProgram) {
  const study::Study more = load("extends: \"@studies/goals\"\ntitle: Our goals\nvariants: {}\n");
  EXPECT_EQ(more.title, "Our goals");
  EXPECT_FALSE(more.scenes.empty());
}

TEST_F(ExtendedStudyTest, SaysWhereAMistakeIsInEitherFile) {
  EXPECT_THAT(complaint_about("extends: \"@base/study.yaml\"\nseeds: none\n"),
              HasSubstr("study.yaml:2:8: seeds: "));
  write("base/study.yaml", "title: Small\nscenes: {}\n");
  EXPECT_THAT(complaint_about("extends: \"@base/study.yaml\"\n"),
              HasSubstr("base/study.yaml:2:9: scenes: "));
}

TEST_F(ExtendedStudyTest, NamesAStudyThatIsThere) {
  EXPECT_THAT(complaint_about("extends: base/study.yaml\n"),
              HasSubstr("study.yaml:1:10: extends: expected a study, \"@studies/NAME\" or "
                        "\"@FILE.yaml\""));
  EXPECT_THAT(complaint_about("extends: \"@studies/goal\"\n"),
              AllOf(HasSubstr("there is no study '@studies/goal'"),
                    HasSubstr("did you mean '@studies/goals'")));
  write("base/study.yaml", "- a list\n");
  EXPECT_THAT(complaint_about("extends: \"@base/study.yaml\"\n"), HasSubstr("is no study"));
}

TEST_F(ExtendedStudyTest, DoesNotExtendItself) {
  EXPECT_THAT(complaint_about("extends: \"@study.yaml\"\n"),
              HasSubstr("extends this study itself"));
  write("base/study.yaml", "extends: \"@../study.yaml\"\n");
  EXPECT_THAT(complaint_about("extends: \"@base/study.yaml\"\n"),
              HasSubstr("extends this study itself"));
}

TEST_F(StudyFileTest, AVariantReplacesWhatItNames) {
  const study::Study quick = load(small_study(), "quick");
  EXPECT_EQ(quick.frames, 3);
  EXPECT_THAT(labels(quick.axes[0]), ElementsAre("4"));
  EXPECT_THAT(labels(quick.axes[1]), ElementsAre("pso", "random"));
  const study::Study one = load(small_study(), "one");
  ASSERT_EQ(one.scenes.size(), 1U);
  EXPECT_EQ(one.frames, 5);
  EXPECT_THAT(
      assignments(one.scenes[0].changes),
      ElementsAre("tile.padding=0.1", "objective={type: stereo_color, window: 3}", "tile.size=16"));
}

TEST_F(StudyFileTest, EveryStudyHasAQuickVariantOfFewFramesSeedsAndTheEndsOfItsValues) {
  std::string text = small_study();
  text.erase(text.find("variants:"));
  text.replace(text.find("[8, 16]"), 7, "[8, 16, 32, 64]");
  text.replace(text.find("seeds: 2"), 8, "seeds: 6");
  text.replace(text.find("frames: 5"), 9, "frames: 50");
  const study::Study quick = load(text, "quick");
  EXPECT_THAT(quick.seeds, ElementsAre(1, 2));
  EXPECT_EQ(quick.frames, 10);
  EXPECT_THAT(labels(quick.axes[0]), ElementsAre("8", "64"));
  EXPECT_THAT(labels(quick.axes[1]), ElementsAre("pso", "random"));
  EXPECT_THAT(message_of<ConfigError>([&] { load(text, "quik"); }),
              HasSubstr("did you mean 'quick'?; its variants are: quick"));
}

TEST_F(StudyFileTest, AStudysOwnQuickVariantChangesTheQuickStudy) {
  std::string text = small_study();
  text.replace(text.find("seeds: [7], "), 12, "");
  text.replace(text.find("seeds: 2"), 8, "seeds: 6");
  const study::Study quick = load(text, "quick");
  EXPECT_THAT(quick.seeds, ElementsAre(1, 2));
  EXPECT_EQ(quick.frames, 3);
  EXPECT_THAT(labels(quick.axes[0]), ElementsAre("4"));
}

TEST_F(StudyFileTest, TheResolvedStudyIsAStudyFileOfTheSameStudy) {
  const study::Study study = load(small_study(), "one");
  const std::string text = to_yaml(study);
  write("resolved.yaml", text);
  EXPECT_EQ(to_yaml(study::load_study(path("resolved.yaml"))), text);
  EXPECT_THAT(text, Not(HasSubstr("variants")));
}

TEST_F(StudyFileTest, MistakesAreNamedWithTheirPlaceAndTheNearestName) {
  EXPECT_THAT(complaint("frames: 5", "frame: 5"),
              AllOf(HasSubstr("study.yaml:13:1"), HasSubstr("did you mean 'frames'")));
  EXPECT_THAT(complaint("frames: 5", "frames: 0"), HasSubstr("study.yaml:13:9"));
  EXPECT_THAT(complaint("seeds: 2", "seeds: [1, 1]"), HasSubstr("the seed 1 is there twice"));
  EXPECT_THAT(complaint("seeds: 2", "seeds: many"), HasSubstr("an integer from 1 to 10000"));
  EXPECT_THAT(complaint("file: box.yaml", "file: bax.yaml"),
              AllOf(HasSubstr("study.yaml:4:15"), HasSubstr("there is no scene file")));
  EXPECT_THAT(complaint("file: box.yaml", "file: \"@scenes/dmo\""),
              AllOf(HasSubstr("study.yaml:4:15"), HasSubstr("did you mean '@scenes/demo'?")));
  EXPECT_THAT(complaint("  box:", "  \"a box\":"), HasSubstr("the name of a scene is a word"));
  EXPECT_THAT(complaint("  box:", "  \"a\\nbox\":"),
              HasSubstr("scenes.a?box: the name of a scene is a word"));
  EXPECT_THAT(
      complaint("frames: 5", "directory: nowhere"),
      AllOf(HasSubstr("study.yaml:13:12: directory: there is no folder"), HasSubstr("nowhere")));
}

TEST_F(StudyFileTest, AxesThatCannotBeAreRefused) {
  EXPECT_THAT(complaint("[8, 16]", "[8, 8]"), HasSubstr("'8' is there twice"));
  EXPECT_THAT(complaint("[8, 16]", "[8, 8.0]"), HasSubstr("'8.0' is there already, as '8'"));
  EXPECT_THAT(complaint("[8, 16]", "[1000, \"1e3\"]"), HasSubstr("'1e3' is there already"));
  EXPECT_THAT(complaint("[8, 16]", "[8, \"a\\nb\"]"), HasSubstr("words on one line"));
  EXPECT_THAT(complaint("[8, 16]", "[]"), HasSubstr("at least one value"));
  EXPECT_THAT(complaint("[8, 16]", "8"), HasSubstr("a list of values, or a map of named cases"));
  EXPECT_THAT(complaint("[8, 16]", "[{a: 1}]"), HasSubstr("give values with a structure names"));
  EXPECT_THAT(complaint("[8, 16]", "{a: {b: 1}}"), HasSubstr("named cases need an axis"));
  EXPECT_THAT(complaint("optimizer.particles: [8", "seed: [8"),
              HasSubstr("the tables have a column 'seed'"));
  EXPECT_THAT(complaint("optimizer.particles: [8", "optimizer..particles: [8"),
              HasSubstr("is no key of a scene"));
}

TEST_F(StudyFileTest, NoAxisHasTheNameOfANumberInTheTables) {
  for (const std::string name : {"mean_error_mm", "fps", "seconds", "mean_sigma_mm",
                                 "mean_error_mm_mean", "lost_frames_sd", "message"})
    EXPECT_THAT(complaint("  method:\n", "  " + name + ":\n"),
                HasSubstr("the tables have a column '" + name + "' of their own; give the axis"));
}

TEST_F(StudyFileTest, EveryVariantIsReadWhicheverIsAskedFor) {
  EXPECT_THAT(complaint("frames: 3", "farmes: 3"), HasSubstr("did you mean 'frames'"));
  EXPECT_THAT(complaint("grid: {optimizer.particles: [4]}", "grid: {optimizer.particle: [4]}"),
              AllOf(HasSubstr("is no axis of the study"), HasSubstr("'optimizer.particles'")));
  EXPECT_THAT(complaint("scenes: [hand]", "scenes: [hans]"), HasSubstr("did you mean 'hand'"));
  EXPECT_THAT(complaint("title: Small", "title: Small", "quik"),
              AllOf(HasSubstr("has no variant 'quik'"), HasSubstr("did you mean 'quick'")));
}

TEST_F(StudyFileTest, PartsOfOtherScenesThatAreNotThereAreNamedWithTheirPlace) {
  EXPECT_THAT(
      complaint("{type: stereo_color, window: 3}", "\"@box.yaml\""),
      AllOf(HasSubstr("study.yaml:5:33: '@box.yaml' cannot be included: "),
            HasSubstr("box.yaml has nothing at 'objective'"), HasSubstr("a map of models")));
  EXPECT_THAT(complaint("{type: random_search}", "\"@bax.yaml\""),
              AllOf(HasSubstr("study.yaml:11:14"), HasSubstr("bax.yaml: cannot be opened")));
  EXPECT_THAT(complaint("set: {tile.size: 16}", "set: {tile: \"@box.yaml\"}"),
              AllOf(HasSubstr("study.yaml:18:"), HasSubstr("has nothing at 'tile'")));
}

TEST_F(StudyFileTest, PlotsAreDrawnOverWhatVaries) {
  EXPECT_THAT(complaint("x: optimizer.particles", "x: optimizer.partikles"),
              AllOf(HasSubstr("is nothing that varies"), HasSubstr("'optimizer.particles'")));
  EXPECT_THAT(complaint("kind: curve", "kind: curv"), HasSubstr("did you mean 'curve'"));
  EXPECT_THAT(complaint("y: mean_error_mm, ", ""), HasSubstr("required key is missing"));
  EXPECT_THAT(complaint("kind: curve", "kind: heatmap"), HasSubstr("is nothing that varies"));
}

TEST_F(StudyFileTest, PlotsOfTracesNeedTraces) {
  const char* kPlots = "kind: curve, x: optimizer.particles, y: mean_error_mm";
  EXPECT_THAT(complaint(kPlots, "kind: convergence"),
              HasSubstr("a plot of kind convergence needs `trace: true` in the study"));
  const auto traced = [&](const std::string& plot) {
    std::string text = small_study();
    text.replace(text.find(kPlots), std::string(kPlots).size(), plot);
    return text + "trace: true\ntolerances: [0.1, 0.01]\n";
  };
  const study::Study study = load(traced("kind: convergence"));
  EXPECT_TRUE(study.trace);
  EXPECT_THAT(study.tolerances, ElementsAre(0.1, 0.01));
  EXPECT_EQ(load(traced("kind: targets, x: cpu_seconds")).plots[0].x, "cpu_seconds");
  EXPECT_THAT(message_of<ConfigError>([&] { load(traced("kind: targets, x: cpu_second")); }),
              HasSubstr("'cpu_second' is nothing that a search spends; did you mean "
                        "'cpu_seconds'?"));
  write("resolved.yaml", to_yaml(study));
  EXPECT_EQ(to_yaml(study::load_study(path("resolved.yaml"))), to_yaml(study));
}

TEST_F(StudyFileTest, PlotsAreOfMetrics) {
  const auto refused = [](const char* name) {
    return AllOf(HasSubstr("study.yaml:15:"),
                 HasSubstr("'" + std::string(name) + "' is no metric of a run"),
                 HasSubstr("did you mean 'mean_error_mm'"), HasSubstr("; there are: frames, "),
                 HasSubstr(", jitter_mm"), HasSubstr(", success_5mm"), HasSubstr(", fps"));
  };
  EXPECT_THAT(complaint("y: mean_error_mm", "y: mean_eror_mm"), refused("mean_eror_mm"));
  EXPECT_THAT(complaint("kind: curve, x: optimizer.particles, y: mean_error_mm",
                        "kind: bars, x: optimizer.particles,  y: mean_error"),
              refused("mean_error"));
  EXPECT_THAT(complaint("kind: curve, x: optimizer.particles, y: mean_error_mm, color: method",
                        "kind: heatmap, x: scene, y: method,   value: mean_error_m"),
              refused("mean_error_m"));
  for (const char* name : {"lost_frames", "time_to_loss_s", "uncertain_frames", "fps"}) {
    const std::string y = "y: " + std::string(name);
    std::string text = small_study();
    EXPECT_EQ(load(text.replace(text.find("y: mean"), 16, y)).plots[0].y, name);
  }
}

TEST_F(StudyFileTest, TablesArePerAnAxis) {
  const std::string text = small_study() + "\ntable_per: optimizer.particles\n";
  EXPECT_THAT(to_yaml(load(text)), HasSubstr("table_per: optimizer.particles\n"));
  EXPECT_THAT(complaint("frames: 5", "frames: 5\ntable_per: optimizer.partikles"),
              AllOf(HasSubstr("is no axis of this study"), HasSubstr("'optimizer.particles'")));
  EXPECT_THAT(complaint("frames: 5", "frames: 5\ntable_per: scene"), HasSubstr("is no axis"));
}

}  // namespace
}  // namespace hypotrack::test
