#include "shape/replay_source.hpp"

#include <gtest/gtest.h>

namespace hypotrack {
namespace {

/// Ten frames at 5 Hz, the first before a gap.
class Counting final : public Source {
 public:
  double gap = 0;  ///< s
  bool is_live = false;

 private:
  const std::vector<Camera>& do_cameras() const override { return cameras_; }
  double do_frame_rate() const override { return 5; }
  std::optional<int> do_frame_count() const override { return 10; }
  std::optional<Frame> do_next() override {
    if (next_ == 10) return std::nullopt;
    Frame frame;
    frame.index = next_++;
    frame.time = frame.index / 5.0 + (frame.index > 0 ? gap : 0);
    return frame;
  }
  bool do_live() const override { return is_live; }
  std::vector<std::string> do_notes() const override { return {"a setting was refused"}; }
  std::vector<std::string> do_statistics() const override {
    return {std::to_string(next_) + " frames"};
  }

  std::vector<Camera> cameras_{Camera{}};
  int next_ = 0;
};

std::vector<int> indices_of(Source& source) {
  std::vector<int> indices;
  while (const auto frame = source.next()) indices.push_back(frame->index);
  return indices;
}

TEST(ReplaySource, GivesTheFirstSecondsAgainAndThenTheRest) {
  auto source = std::make_unique<Counting>();
  const std::vector<Frame> first = first_seconds(*source, 0.6);
  ASSERT_EQ(first.size(), 3u);
  ReplaySource again(*source, first);
  EXPECT_EQ(again.frame_count(), 3);
  EXPECT_EQ(again.frame_rate(), 5);
  EXPECT_EQ(indices_of(again), (std::vector{0, 1, 2}));
  ReplaySource all(std::move(source), first);
  EXPECT_EQ(all.frame_count(), 10);
  EXPECT_EQ(all.cameras().size(), 1u);
  EXPECT_EQ(indices_of(all), (std::vector{0, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
}

TEST(ReplaySource, TakesTheFirstSecondsByTimeWhereThereIsAGap) {
  Counting source;
  source.gap = 0.4;
  EXPECT_EQ(first_seconds(source, 0.6).size(), 2u) << "at 0 and 0.6 s";
}

TEST(ReplaySource, SaysWhatItsSourceSays) {
  auto source = std::make_unique<Counting>();
  const std::vector<Frame> first = first_seconds(*source, 0.6);
  ReplaySource all(std::move(source), first);
  EXPECT_EQ(all.notes(), std::vector<std::string>{"a setting was refused"});
  indices_of(all);
  EXPECT_EQ(all.statistics(), std::vector<std::string>{"10 frames"});
}

TEST(ReplaySource, IsLiveIfItsSourceIs) {
  auto source = std::make_unique<Counting>();
  EXPECT_FALSE(ReplaySource(*source, {}).live());
  source->is_live = true;
  EXPECT_TRUE(ReplaySource(*source, {}).live());
  EXPECT_TRUE(ReplaySource(std::move(source), {}).live());
}

TEST(ReplaySource, TakesAShortSourceAsItIs) {
  Counting source;
  EXPECT_EQ(first_seconds(source, 60).size(), 10u);
}

}  // namespace
}  // namespace hypotrack
