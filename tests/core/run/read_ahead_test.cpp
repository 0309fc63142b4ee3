#include "run/read_ahead.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <oneapi/tbb/task_arena.h>

#include <atomic>
#include <optional>
#include <thread>
#include <vector>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack {
namespace {

/// Counts, and remembers how far it was read and by whom.
class Numbers final : public Source {
 public:
  explicit Numbers(int count) : count_(count) {}

  std::atomic<int> read = 0;
  std::atomic<std::thread::id> thread;
  std::atomic<int> most_threads = 0;
  int fails_at = -1;
  bool is_live = false;

 private:
  const std::vector<Camera>& do_cameras() const override { return cameras_; }
  double do_frame_rate() const override { return 30; }
  bool do_live() const override { return is_live; }
  std::optional<Frame> do_next() override {
    thread = std::this_thread::get_id();
    most_threads = tbb::this_task_arena::max_concurrency();
    const int index = read++;
    if (index == fails_at) throw DataError("the disk is gone");
    if (index == count_) return std::nullopt;
    Frame frame;
    frame.index = index;
    return frame;
  }

  int count_;
  std::vector<Camera> cameras_;
};

std::vector<int> rest_of(ReadAhead& frames) {
  std::vector<int> out;
  while (const auto frame = frames.next()) out.push_back(frame->index);
  return out;
}

TEST(ReadAhead, GivesAllFramesInOrder) {
  Numbers source(20);
  ReadAhead frames(source, std::nullopt, 1);
  std::vector<int> expected(20);
  for (int i = 0; i < 20; ++i) expected[static_cast<std::size_t>(i)] = i;
  EXPECT_EQ(rest_of(frames), expected);
}

TEST(ReadAhead, ReadsNoFrameBeyondTheLimit) {
  Numbers source(20);
  ReadAhead frames(source, 3, 1);
  EXPECT_THAT(rest_of(frames), ::testing::ElementsAre(0, 1, 2));
  EXPECT_EQ(source.read, 3);
}

TEST(ReadAhead, UsesNoMoreThreadsThanItIsGiven) {
  for (const int threads : {1, 3}) {
    Numbers source(2);
    ReadAhead frames(source, std::nullopt, threads);
    rest_of(frames);
    EXPECT_EQ(source.most_threads, threads);
  }
}

TEST(ReadAhead, ReadsAFewFramesWhileNobodyAsks) {
  Numbers source(1000);
  {
    const ReadAhead frames(source, std::nullopt, 1);
    while (source.read < 3) std::this_thread::yield();
  }
  EXPECT_LT(source.read, 10);
}

TEST(ReadAhead, ThrowsAnErrorInThePlaceOfItsFrame) {
  Numbers source(20);
  source.fails_at = 2;
  ReadAhead frames(source, std::nullopt, 1);
  EXPECT_EQ(frames.next()->index, 0);
  EXPECT_EQ(frames.next()->index, 1);
  EXPECT_EQ(test::message_of<DataError>([&] { frames.next(); }), "the disk is gone");
}

TEST(ReadAhead, AsksALiveSourceWhenAFrameIsNeeded) {
  Numbers source(20);
  source.is_live = true;
  ReadAhead frames(source, std::nullopt, 1);
  EXPECT_EQ(source.read, 0);
  EXPECT_EQ(frames.next()->index, 0);
  EXPECT_EQ(source.read, 1);
  EXPECT_EQ(source.thread, std::this_thread::get_id());
}

}  // namespace
}  // namespace hypotrack
