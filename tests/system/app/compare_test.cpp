#include "compare_test.hpp"

#include <nlohmann/json.hpp>
#include <set>

namespace hypotrack::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsSupersetOf;
using testing::Not;
using testing::SizeIs;

TEST_F(CompareTest, MakesEveryRunAndTheTables) {
  const Outcome outcome = compare(study());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("4 of 4 runs are there, 0 failed"));
  EXPECT_THAT(names_in(path("out")), IsSupersetOf({"cells.csv", "plan.txt", "results.csv", "runs",
                                                   "study.yaml", "timing.csv"}));
  ASSERT_THAT(run_names(), SizeIs(4));
  const auto folder = path("out/runs") / run_names().front();
  EXPECT_THAT(names_in(folder), IsSupersetOf({"cell.json", "errors.csv", "joints.csv", "run.yaml",
                                              "summary.json", "timing.json", "track.csv"}));
  EXPECT_THAT(lines_of(read_text(folder / "track.csv")), SizeIs(4));  // `frames` and the header
  EXPECT_THAT(names_in(path("out/.working")), testing::IsEmpty());
  const auto results = lines_of(table("results.csv"));
  ASSERT_THAT(results, SizeIs(5));
  EXPECT_THAT(results[0], HasSubstr("scene,optimizer.particles,seed,status,message,"));
  EXPECT_THAT(results[2], testing::StartsWith("box,4,2,ok,,"));
  EXPECT_THAT(lines_of(table("cells.csv")), SizeIs(3));
  EXPECT_THAT(lines_of(table("timing.csv")), SizeIs(5));
}

TEST_F(CompareTest, ARunIsWhatTheProgramMakesOfItsSceneAndSettings) {
  ASSERT_EQ(compare(study()).exit_code, 0);
  const auto cell_of = [&](const std::string& name) {
    return nlohmann::json::parse(read_text(path("out/runs") / name / "cell.json"));
  };
  const nlohmann::json expected = {
      {"scene", "box"}, {"settings", {{"optimizer.particles", 8}}}, {"seed", 2}};
  const auto names = run_names();
  const auto found = std::find_if(names.begin(), names.end(),
                                  [&](const auto& name) { return cell_of(name) == expected; });
  ASSERT_NE(found, names.end());
  const Outcome alone = run_program(
      {"run", path("box.yaml").string(), "--out", path("alone").string(), "--set",
       "optimizer.particles=8", "--set", "source.sensor.seed=2", "--seed", "2", "--frames", "3"});
  ASSERT_EQ(alone.exit_code, 0) << alone.err;
  EXPECT_EQ(track_without_times(path("out/runs") / *found), track_without_times(path("alone")));
}

TEST_F(CompareTest, TheSameStudyTwiceGivesTheSameTables) {
  ASSERT_EQ(compare(study(), "a").exit_code, 0);
  ASSERT_EQ(compare(study(), "b", {"--jobs", "1"}).exit_code, 0);
  EXPECT_EQ(table("results.csv", "a"), table("results.csv", "b"));
  EXPECT_EQ(table("cells.csv", "a"), table("cells.csv", "b"));
  EXPECT_THAT(table("results.csv", "a"), Not(HasSubstr("fps")));
}

TEST_F(CompareTest, RunsThatAreThereAreNotMadeAgain) {
  ASSERT_EQ(compare(study()).exit_code, 0);
  const std::string timing = table("timing.csv");
  const std::string results = table("results.csv");
  const Outcome again = compare(study());
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_THAT(again.err, HasSubstr("0 to make here"));
  EXPECT_EQ(table("timing.csv"), timing);
  EXPECT_EQ(table("results.csv"), results);
}

TEST_F(CompareTest, AStudyThatGrowsMakesOnlyWhatIsNew) {
  ASSERT_EQ(compare(study()).exit_code, 0);
  const Outcome more = compare(replaced(study(), "seeds: 2", "seeds: 3"));
  EXPECT_EQ(more.exit_code, 0) << more.err;
  EXPECT_THAT(more.err, HasSubstr("2 to make here"));
  EXPECT_THAT(lines_of(table("results.csv")), SizeIs(7));
}

TEST_F(CompareTest, AVariantIsAStudyOfItsOwn) {
  const std::string text = study() + "variants: {quick: {seeds: 1, frames: 2}}\n";
  ASSERT_EQ(compare(text, "out", {"--variant", "quick"}).exit_code, 0);
  EXPECT_THAT(run_names(), SizeIs(2));
  const Outcome full = compare(text);
  EXPECT_EQ(full.exit_code, 1);
  EXPECT_THAT(full.err, AllOf(HasSubstr("holds another study: 2 of its 2 runs"),
                              HasSubstr("they differ in: seeds, frames")));
  EXPECT_THAT(run_names(), SizeIs(2));
}

TEST_F(CompareTest, NamedCasesReplaceWholeParts) {
  const std::string text = replaced(study(), "  optimizer.particles: [4, 8]\n",
                                    "  method:\n"
                                    "    pso: {optimizer: {type: pso, particles: 4}}\n"
                                    "    random: {optimizer: {type: random_search}}\n");
  const Outcome outcome = compare(text);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(table("results.csv"), AllOf(HasSubstr("box,pso,1,ok"), HasSubstr("box,random,2,ok")));
}

TEST_F(CompareTest, OverlayVideosAreMadeWhereTheStudyAsksForThem) {
  ASSERT_EQ(compare(study() + "overlay: true\n").exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(path("out/runs") / run_names().front() / "overlay.mp4"));
}

TEST_F(CompareTest, RecordedSourcesAreMadeOnceForAllRuns) {
  const std::string text = replaced(study(), "{file: box.yaml}",
                                    "{file: box.yaml}\n  far: {file: box.yaml, set: "
                                    "{source.cameras.focal_px: 120, tile.size: 48}}") +
                           "recordings: true\nredraw: nothing\n";
  const Outcome outcome = compare(text, "a");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(names_in(path("a/recordings")), SizeIs(2));  // of 4 cells with 2 seeds each
  EXPECT_THAT(names_in(path("a/.working")), testing::IsEmpty());
  const std::string protocol = read_text(path("a/runs") / run_names("a").back() / "run.yaml");
  EXPECT_THAT(protocol, AllOf(HasSubstr("type: image_sequence"), HasSubstr("size: 48")));
  ASSERT_EQ(compare(text, "b").exit_code, 0);
  EXPECT_EQ(table("results.csv", "a"), table("results.csv", "b"));
}

TEST_F(CompareTest, UncompressedRecordingsGiveTheSameTables) {
  const std::string text = study() + "recordings: true\nredraw: nothing\n";
  ASSERT_EQ(compare(text, "a").exit_code, 0);
  const Outcome outcome = compare(text, "b", {"--pictures", "ppm"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto recording = path("b/recordings") / names_in(path("b/recordings")).front();
  EXPECT_TRUE(std::filesystem::exists(recording / "recording/left_000000.ppm"));
  EXPECT_FALSE(std::filesystem::exists(recording / "recording/left_000000.png"));
  EXPECT_EQ(table("results.csv", "a"), table("results.csv", "b"));
}

TEST_F(CompareTest, SeedsGetPicturesOfTheirOwnThatAllSettingsShare) {
  const std::string recorded = study() + "recordings: true\n";
  ASSERT_EQ(compare(recorded, "out", {"--shard", "1/2"}).exit_code, 0);
  std::set<std::string> pictures;
  const auto recordings = names_in(path("out/recordings"));
  ASSERT_THAT(recordings, SizeIs(2));  // of 2 cells with 2 seeds each; the other half needs them
  for (const std::string& name : recordings)
    pictures.insert(read_text(path("out/recordings") / name / "recording/left_000000.png"));
  EXPECT_THAT(pictures, SizeIs(2));
  ASSERT_EQ(compare(recorded, "out", {"--shard", "2/2"}).exit_code, 0);
  EXPECT_THAT(names_in(path("out/recordings")), testing::IsEmpty());
  ASSERT_EQ(compare(study(), "unrecorded").exit_code, 0);
  EXPECT_EQ(table("results.csv"), table("results.csv", "unrecorded"));
}

TEST_F(CompareTest, RecordingsMadeAheadOfTheirRunsChangeNoTable) {
  const std::string recorded = replaced(study(), "seeds: 2", "seeds: 4") + "recordings: true\n";
  const Outcome one_by_one = compare(recorded, "a", {"--jobs", "1", "--threads", "1"});
  ASSERT_EQ(one_by_one.exit_code, 0) << one_by_one.err;
  const Outcome together = compare(recorded, "b", {"--jobs", "8", "--threads", "1"});
  ASSERT_EQ(together.exit_code, 0) << together.err;
  EXPECT_EQ(table("results.csv", "a"), table("results.csv", "b"));
  EXPECT_THAT(names_in(path("b/recordings")), testing::IsEmpty());
}

TEST_F(CompareTest, APartOfTheSceneGoesIntoAnother) {
  const std::string text =
      replaced(study(), "{file: box.yaml}", "{file: box.yaml, set: {objective: [\"@objective\"]}}");
  ASSERT_EQ(compare(text).exit_code, 0);
  ASSERT_EQ(compare(study(), "plain").exit_code, 0);
  EXPECT_EQ(table("results.csv"), table("results.csv", "plain"));
}

TEST_F(CompareTest, APartOfAnotherSceneIsTakenFromTheStudysFolder) {
  ASSERT_EQ(run_program({"synth", path("box.yaml").string(), "--out", path("recording").string()})
                .exit_code,
            0);
  const std::string text = replaced(study(), "{file: box.yaml}",
                                    "{file: box.yaml, set: {source: \"@recording/scene.yaml\"}}");
  Start elsewhere = start(text, "out");
  elsewhere.directory = path("recording");  // to which its paths refer, not the study's
  const Outcome outcome = run_program(elsewhere);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::string protocol = read_text(path("out/runs") / run_names().back() / "run.yaml");
  EXPECT_THAT(protocol, AllOf(HasSubstr(path("recording/left_%06d.png").string()),
                              testing::Not(HasSubstr("@"))));
}

TEST_F(CompareTest, RelativePathsInChangesReferToTheStudysFolder) {
  ASSERT_EQ(run_program({"synth", path("box.yaml").string(), "--out", path("recording").string()})
                .exit_code,
            0);
  const std::string text =
      replaced(study(), "{file: box.yaml}",
               "{file: recording/scene.yaml, set: {source.left: recording/left_%06d.png, "
               "source.right: recording/right_%06d.png}}");
  Start elsewhere = start(text, "out");
  elsewhere.directory = path("recording");
  const Outcome outcome = run_program(elsewhere);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
}

}  // namespace
}  // namespace hypotrack::test
