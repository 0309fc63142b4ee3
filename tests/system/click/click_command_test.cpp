
#include "app_test.hpp"
#include "hypotrack/api/media.hpp"

namespace hypotrack::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class ClickCommand : public AppTest {
 protected:
  Outcome draw(const std::string& text, const std::string& picture = "start.png") const {
    return run_program({"validate", scene(text), "--draw", path(picture).string()});
  }
  /// The start command without a display.
  Outcome start_without_display(const std::vector<std::string>& more,
                                const std::string& display = "") const {
    std::vector<std::string> arguments{"click", scene(box_scene())};
    arguments.insert(arguments.end(), more.begin(), more.end());
    Start start;
    start.arguments = arguments;
    start.environment = {"DISPLAY=" + display, "WAYLAND_DISPLAY=", "QT_QPA_PLATFORM="};
    return run_program(start);
  }
};

TEST_F(ClickCommand, DrawTheStartOverBothViews) {
  const Outcome outcome = draw(box_scene());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("ok"));
  EXPECT_THAT(outcome.err, HasSubstr("start.png: frame 0, start: truth"));
  const cv::Mat picture = read_image(path("start.png").string());
  EXPECT_EQ(picture.cols, 320);
  EXPECT_GT(picture.rows, 120);
}

TEST_F(ClickCommand, DrawAStartThatIsRefusedBecauseItIsBehindTheCamera) {
  const std::string text = replaced(box_scene(), "init: {from: truth}",
                                    "init: {from: rest, pose: {box: {position_mm: [0, 0, -400]}}}");
  const Outcome outcome = draw(text);
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("lies at or behind camera 0"));
  EXPECT_EQ(read_image(path("start.png").string()).cols, 320);
}

TEST_F(ClickCommand, DrawWhatIsFoundAlsoWhereSearchesAreInTheBackground) {
  const std::string text = replaced(box_scene(), "init: {from: truth}",
                                    "init: {from: global_search}\nrecovery: {run: background}");
  EXPECT_THAT(draw(text).err, HasSubstr("start: global_search; box found"));
}

TEST_F(ClickCommand, DrawWhatIsFoundOrSayThatNothingIs) {
  const std::string text =
      replaced(box_scene(), "init: {from: truth}", "init: {from: global_search}");
  const Outcome found = draw(text);
  EXPECT_EQ(found.exit_code, 0) << found.err;
  EXPECT_THAT(found.err, HasSubstr("start: global_search; box found"));
  const Outcome nothing = draw(
      replaced(replaced(text, "[0, 0, 400]", "[3000, 0, 400]"), "[20, 10, 420]", "[3000, 0, 400]"),
      "nothing.png");
  EXPECT_EQ(nothing.exit_code, 0) << nothing.err;
  EXPECT_THAT(nothing.err, HasSubstr("start: global_search; box not found"));
  const cv::Mat with = read_image(path("start.png").string());
  const cv::Mat without = read_image(path("nothing.png").string());
  EXPECT_GT(with.rows, without.rows) << "the share in view and the legend of what is drawn";
}

TEST_F(ClickCommand, RefuseAPictureThatCannotBeWritten) {
  EXPECT_THAT(draw(box_scene(), "start.jpg").err, HasSubstr("ends in .png"));
  const Outcome outcome = draw(box_scene(), "none/start.png");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("check that the folder exists"),
                                 HasSubstr("another file with --draw")));
}

TEST_F(ClickCommand, StartFromClicksAndRepeatTheRun) {
  // Corners of the box as the synthetic cameras see them.
  write_text(path("clicks.yaml"), R"(clicks:
  - {landmark: corner_100, left: [91.6, 51.4], right: [55.2, 51.4]}
  - {landmark: corner_110, left: [93.2, 76.2], right: [58.8, 76.2]}
  - {landmark: corner_010, left: [61.7, 71.3], right: [30.9, 71.3]}
)");
  const std::string text =
      replaced(box_scene(), "init: {from: truth}", "init: {from: clicks, file: clicks.yaml}");
  const Outcome checked = run_program({"validate", scene(text)});
  EXPECT_EQ(checked.exit_code, 0) << checked.err;
  EXPECT_THAT(checked.err, AllOf(HasSubstr("3 clicks"), HasSubstr("box.corner_100"),
                                 HasSubstr(" mm, "), HasSubstr(" px")));
  const Outcome outcome = run(text);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("3 clicks"));
  const Outcome again =
      run_program({"run", path("out/run.yaml").string(), "--out", path("again").string()});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(track_without_times(path("out")), track_without_times(path("again")));
}

TEST_F(ClickCommand, RefuseClicksIntoAnotherFrameThanTheFirst) {
  write_text(path("clicks.yaml"), R"(frame: 12
pictures: ["ff", "ff"]
clicks:
  - {landmark: corner_100, left: [91.6, 51.4], right: [55.2, 51.4]}
  - {landmark: corner_110, left: [93.2, 76.2], right: [58.8, 76.2]}
  - {landmark: corner_010, left: [61.7, 71.3], right: [30.9, 71.3]}
)");
  const std::string text =
      replaced(box_scene(), "init: {from: truth}", "init: {from: clicks, file: clicks.yaml}");
  expect_refused(text, {"clicks.yaml: the landmarks were clicked in frame 12",
                        "not those of frame 0, where this run begins"});
}

TEST_F(ClickCommand, NeedTheFileOfTheClicks) {
  expect_refused(replaced(box_scene(), "init: {from: truth}", "init: {from: clicks}"),
                 {"init.from is 'clicks' but init.file names none"});
}

TEST_F(ClickCommand, SayWhatToDoWithoutADisplay) {
  const Outcome outcome = start_without_display({"--out", path("pose.yaml").string()});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("there is no display"), HasSubstr("from: clicks"),
                                 HasSubstr("neither DISPLAY nor")));
  EXPECT_FALSE(std::filesystem::exists(path("pose.yaml")));
  EXPECT_THAT(start_without_display({"--out", path("pose.txt").string()}).err,
              HasSubstr("ends in .yaml"));
  EXPECT_THAT(start_without_display({"--out", path("pose.yaml").string()}, ":4711").err,
              AllOf(HasSubstr("the display :4711 cannot be reached"), Not(HasSubstr("qt"))));
  EXPECT_EQ(start_without_display({}).exit_code, 2) << "--out is required";
}

}  // namespace
}  // namespace hypotrack::test
