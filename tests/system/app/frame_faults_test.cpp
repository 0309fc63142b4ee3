#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app_test.hpp"

namespace hypotrack::test {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;

class FrameFaultsTest : public AppTest {
 protected:
  Outcome run_with(const std::string& fault, const std::vector<std::string>& more = {}) const {
    return run(
        replaced(box_scene(), "type: synthetic", "type: synthetic\n  faults: [{" + fault + "}]"),
        more);
  }
  /// Records five sound frames; returns the scene that tracks them.
  std::string recording() const {
    const Outcome outcome =
        run_program({"synth", scene(box_scene()), "--out", path("recording").string()});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return path("recording/scene.yaml").string();
  }
  std::string picture(const std::string& view) const {
    return path("recording/" + view + "_%06d.png").string();
  }
  nlohmann::json faults() const {
    return nlohmann::json::parse(read_text(path("out/summary.json"))).at("faults");
  }
  std::vector<std::string> rows() const { return lines_of(read_text(path("out/track.csv"))); }
};

TEST_F(FrameFaultsTest, SoundFramesHaveNone) {
  const Outcome outcome = run(box_scene());
  EXPECT_THAT(outcome.err, Not(HasSubstr("note:")));
  EXPECT_EQ(faults(), nlohmann::json::object());
  ASSERT_THAT(rows(), SizeIs(6));
  EXPECT_THAT(rows()[0], EndsWith(",fault"));
  for (std::size_t i = 1; i < 6; ++i) EXPECT_THAT(rows()[i], EndsWith(","));
}

TEST_F(FrameFaultsTest, AreNotedOnceCountedAndInTheTable) {
  const Outcome outcome = run_with("frames: [2, 3], kind: frozen, view: 1");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("note: frame 2: the second view repeats an earlier picture"));
  EXPECT_THAT(outcome.err, Not(HasSubstr("note: frame 3:")));
  EXPECT_THAT(outcome.out, HasSubstr("2 missing"));
  EXPECT_EQ(faults(), (nlohmann::json{{"frozen", 2}}));
  for (const std::size_t frame : {2, 3}) {
    EXPECT_THAT(rows()[1 + frame], HasSubstr(",missing,nan,0,"));
    EXPECT_THAT(rows()[1 + frame], EndsWith(",frozen"));
  }
  EXPECT_THAT(rows()[5], EndsWith(","));
}

TEST_F(FrameFaultsTest, AreSearchedWhereTheSceneSaysSo) {
  const Outcome outcome =
      run_with("frames: [2, 3], kind: exchanged", {"--set", "status.check_pictures=false"});
  EXPECT_THAT(outcome.err, Not(HasSubstr("note:")));
  EXPECT_EQ(faults(), nlohmann::json::object());
  EXPECT_THAT(outcome.out, HasSubstr("0 missing"));
}

TEST_F(FrameFaultsTest, ExchangedViewsArePointedOutBeforeARun) {
  const std::vector<std::string> exchanged{recording(), "--set", "source.left=" + picture("right"),
                                           "--set", "source.right=" + picture("left")};
  const auto note =
      HasSubstr("note: frame 0: the first two views match the cameras better the other way round");
  std::vector<std::string> arguments{"validate"};
  arguments.insert(arguments.end(), exchanged.begin(), exchanged.end());
  const Outcome validated = run_program(arguments);
  EXPECT_EQ(validated.exit_code, 0);
  EXPECT_THAT(validated.err, note);
  arguments.front() = "run";
  arguments.insert(arguments.end(), {"--out", path("out").string()});
  const Outcome outcome = run_program(arguments);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, note);
  EXPECT_EQ(faults(), (nlohmann::json{{"exchanged", 5}}));
}

TEST_F(FrameFaultsTest, OnePictureForBothViewsIsPointedOut) {
  const std::string file = recording();
  const std::string same = "source.right=" + picture("left");
  const auto note = HasSubstr("note: frame 0: the first two views show the same picture");
  EXPECT_THAT(run_program({"validate", file, "--set", same}).err, note);
  EXPECT_THAT(run_program({"run", file, "--out", path("out").string(), "--set", same}).err, note);
  EXPECT_EQ(faults(), (nlohmann::json{{"same_picture", 5}}));
}

TEST_F(FrameFaultsTest, AViewThatFreezesAtOnceIsPointedOutBeforeARun) {
  const std::string file = recording();
  for (const int frame : {1, 2, 3, 4})
    std::filesystem::copy_file(path("recording/right_000000.png"),
                               path(fmt::format("recording/right_{:06d}.png", frame)),
                               std::filesystem::copy_options::overwrite_existing);
  EXPECT_THAT(run_program({"validate", file}).err,
              HasSubstr("note: frame 1: the second view repeats an earlier picture"));
}

TEST_F(FrameFaultsTest, AGapInTimeIsNotedAndTheFrameSearched) {
  const std::string file = recording();
  write_text(path("times.txt"), "0\n0.03\n0.06\n3\n3.03\n");
  write_text(file, replaced(read_text(file), "frame_rate: 30",
                            "timestamps: {file: " + path("times.txt").string() + ", unit: s}"));
  const Outcome outcome = run_program({"run", file, "--out", path("out").string()});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("note: frame 3: no frame came for a while"));
  EXPECT_EQ(faults(), (nlohmann::json{{"time_gap", 1}}));
  EXPECT_THAT(outcome.out, HasSubstr("0 missing"));
  EXPECT_THAT(rows()[4], EndsWith(",time_gap"));
}

}  // namespace
}  // namespace hypotrack::test
