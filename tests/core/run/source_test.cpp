#include "hypotrack/plugin/source.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "test_models.hpp"

namespace hypotrack {
namespace {

/// A camera whose clock stands still.
class StoppedClock final : public Source {
 public:
  explicit StoppedClock(bool live) : live_(live), cameras_(1) {
    cameras_[0].fx = cameras_[0].fy = 100;
  }

 private:
  const std::vector<Camera>& do_cameras() const override { return cameras_; }
  double do_frame_rate() const override { return 10; }
  bool do_live() const override { return live_; }
  std::optional<Frame> do_next() override {
    Frame frame;
    frame.index = next_++;
    frame.time = 7;
    return frame;
  }

  bool live_;
  std::vector<Camera> cameras_;
  int next_ = 0;
};

/// A source of frames without views, with these numbers and times. The first ones have stamps.
class ListedFrames final : public Source {
 public:
  explicit ListedFrames(std::vector<std::pair<int, double>> frames, std::size_t stamped = 0)
      : frames_(std::move(frames)), stamped_(stamped), cameras_(1) {
    cameras_[0].fx = cameras_[0].fy = 100;
  }

 private:
  const std::vector<Camera>& do_cameras() const override { return cameras_; }
  double do_frame_rate() const override { return 10; }
  std::optional<Frame> do_next() override {
    if (next_ == frames_.size()) return std::nullopt;
    Frame frame;
    if (next_ < stamped_) frame.stamp = 1;
    std::tie(frame.index, frame.time) = frames_[next_++];
    return frame;
  }

  std::vector<std::pair<int, double>> frames_;
  std::size_t stamped_;  ///< number of frames with a stamp, from the first on
  std::vector<Camera> cameras_;
  std::size_t next_ = 0;
};

class SourceTest : public ::testing::Test {
 protected:
  using Frames = std::vector<std::pair<int, double>>;

  /// Reads all frames.
  void read(Frames frames) const {
    ListedFrames source(std::move(frames));
    source.check_for(scene_);
    while (source.next()) {
    }
  }
  std::string refusal(Frames frames) const {
    return test::message_of<DataError>([&] { read(std::move(frames)); });
  }
  Scene scene_{{{"box", std::make_shared<Model>(test::make_test_box({0.1, 0.1, 0.1}))}}};
};

TEST_F(SourceTest, MovesFramesThatComeAtTheSameTime) {
  StoppedClock source(false);
  EXPECT_EQ(source.next()->time, 7);
  const Frame second = *source.next();
  EXPECT_DOUBLE_EQ(second.time, 7.1);
  EXPECT_EQ(second.fault, FrameFault::time_back);
}

TEST_F(SourceTest, RefusesNumbersThatDoNotGrowAndTimesThatAreNone) {
  using testing::AllOf, testing::HasSubstr;
  EXPECT_NO_THROW(read({{0, 0}, {1, 0.1}, {5, 0.5}}));
  EXPECT_THAT(refusal({{0, 0}, {0, 0.1}}), AllOf(HasSubstr("frame 0 at 0.1 s follows frame 0"),
                                                 HasSubstr("this is a bug in the source")));
  EXPECT_THAT(refusal({{2, 0}, {1, 0.1}}), HasSubstr("frame 1 at 0.1 s follows frame 2"));
  EXPECT_THAT(refusal({{-1, 0}}), HasSubstr("frame -1 at 0 s"));
  EXPECT_THAT(refusal({{0, std::nan("")}}), HasSubstr("frame 0 at nan s"));
}

TEST_F(SourceTest, RefusesFramesOfWhichSomeHaveAStamp) {
  const auto read = [&](std::size_t stamped) {
    ListedFrames source({{0, 0}, {1, 1}}, stamped);
    source.set_label("listed", "listed.so");
    while (source.next()) {
    }
  };
  EXPECT_NO_THROW(read(0));
  EXPECT_NO_THROW(read(2));
  EXPECT_THAT(test::message_of<DataError>([&] { read(1); }),
              testing::HasSubstr("listed: frame 1 lacks a stamp, the first has one"));
}

}  // namespace
}  // namespace hypotrack
