#include "output/run/run_output.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/files.hpp"
#include "output/run/output_queue.hpp"
#include "test_models.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

using test::message_of;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

/// Writes its calls into one file.
class Diary final : public Output {
 public:
  explicit Diary(std::string name) : names_{std::move(name)} {}

  std::vector<std::string> own_columns;
  std::string asks_for;
  bool draws = false;
  bool fails = false;
  int fails_at = -1;

 private:
  std::vector<std::string> do_file_names() const override { return names_; }
  void do_begin(OutputContext& run) override {
    if (draws) run.renderer();
    file_.emplace(run.file(asks_for.empty() ? names_.front() : asks_for));
    file_->write("begin");
  }
  void do_online(const Frame& frame, const Solution&) override {
    file_->write(" online " + std::to_string(frame.index));
  }
  void do_frame(const Frame& frame, const Solution&) override {
    if (frame.index == fails_at) throw OutputError("the diary is full");
    file_->write(" frame " + std::to_string(frame.index));
  }
  void do_finish(bool complete) override {
    if (fails) throw OutputError("the diary is full");
    file_->write(complete ? " finish" : " finish early");
  }

  std::vector<std::string> do_columns() const override { return own_columns; }

  std::vector<std::string> names_;
  std::optional<TextFile> file_;
};

class RunOutputTest : public ::testing::Test {
 protected:
  std::unique_ptr<RunOutput> open(std::vector<NamedOutput> outputs, bool fixed_lag = false) const {
    Camera camera;
    camera.width = 64;
    camera.height = 48;
    return std::make_unique<RunOutput>(
        scene_, std::vector<Camera>{camera},
        RunOutput::Options{
            .directory = out(), .resolved = "seed: 1\n", .backend = "none", .fixed_lag = fixed_lag},
        std::move(outputs));
  }
  std::unique_ptr<RunOutput> open(const std::string& name, bool fixed_lag = false) const {
    return open(one(std::make_unique<Diary>(name)), fixed_lag);
  }
  static std::vector<NamedOutput> one(std::unique_ptr<Output> output) {
    std::vector<NamedOutput> outputs;
    outputs.push_back({"diary", std::move(output)});
    return outputs;
  }

  std::filesystem::path out() const { return folder_.path() / "out"; }
  std::string text(const std::string& name) const {
    std::stringstream text;
    text << std::ifstream(out() / name).rdbuf();
    return text.str();
  }
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(out()))
      names.push_back(entry.path().filename().string());
    return names;
  }

  Frame frame(int index) const {
    Frame frame;
    frame.index = index;
    return frame;
  }
  Solution solution(int index) const {
    Solution solution;
    solution.frame = index;
    solution.state = scene_.rest_state();
    solution.landmarks = scene_.landmarks(solution.state);
    solution.models = {Status::tracked};
    solution.probabilities = {1.0};
    solution.status = Status::tracked;
    return solution;
  }

  const test::TemporaryDirectory folder_;
  const Scene scene_{{{"box", std::make_shared<Model>(test::make_test_box())}}};
};

TEST_F(RunOutputTest, FilesGrowUnderTheirNamesAndTheSummaryComesLast) {
  const auto output = open("diary.txt");
  output->add(frame(0), solution(0));
  output->add(frame(1), solution(1));
  EXPECT_THAT(names(), UnorderedElementsAre("diary.txt", "run.yaml"));
  output->finish(true);
  EXPECT_THAT(names(), UnorderedElementsAre("diary.txt", "run.yaml", "summary.json"));
  EXPECT_EQ(text("diary.txt"), "begin online 0 frame 0 online 1 frame 1 finish");
}

TEST_F(RunOutputTest, SmoothedFramesComeAfterTheOnlineOnes) {
  const auto output = open("diary.txt", true);
  for (const int i : {0, 1}) output->add_online(frame(i), solution(i));
  for (const int i : {0, 1}) output->add(frame(i), solution(i));
  output->finish(false);
  EXPECT_EQ(text("diary.txt"), "begin online 0 online 1 frame 0 frame 1 finish early");
}

TEST_F(RunOutputTest, WithoutFramesNothingStays) {
  open("diary.txt");
  EXPECT_FALSE(std::filesystem::exists(out()));
}

TEST_F(RunOutputTest, FramesSoFarStay) {
  open("diary.txt")->add(frame(0), solution(0));
  EXPECT_EQ(text("diary.txt"), "begin online 0 frame 0");
}

TEST_F(RunOutputTest, AnOutputThatFailsAtTheEndLeavesTheOthersWhole) {
  auto bad = std::make_unique<Diary>("bad.txt");
  bad->fails = true;
  std::vector<NamedOutput> outputs = one(std::move(bad));
  outputs.push_back({"good", std::make_unique<Diary>("good.txt")});
  const auto output = open(std::move(outputs));
  output->add(frame(0), solution(0));
  EXPECT_EQ(message_of<OutputError>([&] { output->finish(true); }), "the diary is full");
  EXPECT_EQ(text("good.txt"), "begin online 0 frame 0 finish");
}

TEST_F(RunOutputTest, TwoOutputsOfOneFileAreRefused) {
  EXPECT_THAT(
      message_of<ConfigError>([&] { open("summary.json"); }),
      HasSubstr("output: metrics and diary both write summary.json; leave one of them out"));
  EXPECT_THAT(message_of<ConfigError>([&] { open("run.yaml"); }), HasSubstr("the run and diary"));
  EXPECT_THAT(message_of<ConfigError>([&] { open("worst_1.jpg"); }),
              HasSubstr("metrics and diary"));
  EXPECT_FALSE(std::filesystem::exists(out()));
}

TEST_F(RunOutputTest, AnOutputThatIsThereTwiceIsRefusedSayingWhichOnesComeByThemselves) {
  std::vector<NamedOutput> outputs = one(std::make_unique<Diary>("diary.txt"));
  outputs.push_back({outputs.front().name, std::make_unique<Diary>("diary.txt")});
  EXPECT_THAT(message_of<ConfigError>([&] { check_outputs(outputs); }),
              AllOf(HasSubstr("diary is there twice, and both write diary.txt"),
                    HasSubstr("the overlay unless output.overlay is false")));
}

TEST_F(RunOutputTest, TwoOutputsOfOneFileAreFoundWithoutARun) {
  EXPECT_NO_THROW(check_outputs(one(std::make_unique<Diary>("diary.txt"))));
  EXPECT_THAT(
      message_of<ConfigError>([&] { check_outputs(one(std::make_unique<Diary>("summary.json"))); }),
      HasSubstr("metrics and diary both write summary.json"));
}

TEST_F(RunOutputTest, FilesThatAnOutputDoesNotNameAreRefused) {
  EXPECT_THAT(message_of<PluginError>([&] { open("../diary.txt"); }),
              AllOf(HasSubstr("output 'diary'"), HasSubstr("'../diary.txt'")));
  auto diary = std::make_unique<Diary>("page_#.txt");
  diary->asks_for = "page_x.txt";
  EXPECT_THAT(message_of<PluginError>([&] { open(one(std::move(diary))); }),
              HasSubstr("'page_x.txt', which is none of its file_names()"));
  EXPECT_FALSE(std::filesystem::exists(out()));
  diary = std::make_unique<Diary>("page_#.txt");
  diary->asks_for = "page_7.txt";
  const auto output = open(one(std::move(diary)));
  output->add(frame(0), solution(0));
  output->finish(true);
  EXPECT_THAT(names(), UnorderedElementsAre("page_7.txt", "run.yaml", "summary.json"));
}

TEST_F(RunOutputTest, ADrawingOutputWithColumnsIsRefused) {
  auto diary = std::make_unique<Diary>("diary.txt");
  diary->draws = true;
  diary->own_columns = {"depth"};
  EXPECT_THAT(message_of<PluginError>([&] { open(one(std::move(diary))); }),
              AllOf(HasSubstr("'diary' adds columns"), HasSubstr("takes the renderer in begin()")));
  EXPECT_FALSE(std::filesystem::exists(out()));
}

TEST_F(RunOutputTest, TwoOutputsOfOneColumnAreFoundWithoutARun) {
  std::vector<NamedOutput> outputs;
  for (const char* name : {"a", "b"}) {
    auto diary = std::make_unique<Diary>(std::string(name) + ".txt");
    diary->own_columns = {"depth"};
    outputs.push_back({name, std::move(diary)});
  }
  EXPECT_THAT(message_of<ConfigError>([&] { check_outputs(outputs); }),
              HasSubstr("output: a and b both add the column 'depth' to track.csv"));
}

TEST_F(RunOutputTest, AQueueGivesAllFramesInOrderToDrawingAndPlainOutputs) {
  auto drawing = std::make_unique<Diary>("drawing.txt");
  drawing->draws = true;
  std::vector<NamedOutput> outputs = one(std::move(drawing));
  outputs.push_back({"plain", std::make_unique<Diary>("plain.txt")});
  const auto output = open(std::move(outputs));
  OutputQueue queue(*output);
  std::string expected = "begin";
  for (int i = 0; i < 40; ++i) {
    queue.add(frame(i), solution(i));
    expected += fmt::format(" online {0} frame {0}", i);
    EXPECT_EQ(text("plain.txt"), expected) << "a crash must not lose it";
  }
  queue.settle();
  output->finish(true);
  EXPECT_EQ(text("drawing.txt"), expected + " finish");
  EXPECT_EQ(text("plain.txt"), expected + " finish");
}

TEST_F(RunOutputTest, AQueueTellsAnErrorOfADrawingOutputOnceAndDrawsNothingAfterIt) {
  auto diary = std::make_unique<Diary>("diary.txt");
  diary->draws = true;
  diary->fails_at = 1;
  const auto output = open(one(std::move(diary)));
  OutputQueue queue(*output);
  queue.add(frame(0), solution(0));
  queue.add(frame(1), solution(1));
  EXPECT_EQ(message_of<OutputError>([&] { queue.settle(); }), "the diary is full");
  queue.add(frame(2), solution(2));
  EXPECT_NO_THROW(queue.settle());
  EXPECT_EQ(text("diary.txt"), "begin online 0 frame 0 online 1");
}

}  // namespace
}  // namespace hypotrack
