#include "session/checked_source.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <utility>

#include "test_models.hpp"

namespace hypotrack {
namespace {

/// A camera whose clock stands still.
class StoppedClock final : public Source {
 public:
  explicit StoppedClock(bool live) : live_(live), cameras_(1) {
    cameras_[0].fx = cameras_[0].fy = 100;
  }
  const std::vector<Camera>& cameras() const override { return cameras_; }
  double frame_rate() const override { return 10; }
  bool live() const override { return live_; }
  std::optional<Frame> next() override {
    Frame frame;
    frame.index = next_++;
    frame.time = 7;
    return frame;
  }

 private:
  bool live_;
  std::vector<Camera> cameras_;
  int next_ = 0;
};

class CheckedSourceTest : public ::testing::Test {
 protected:
  CheckedSource checked(bool live) const {
    return {std::make_unique<StoppedClock>(live), scene_, "stopped"};
  }
  Scene scene_{{{"box", std::make_shared<Model>(test::make_test_box({0.1, 0.1, 0.1}))}}};
};

TEST_F(CheckedSourceTest, IsLiveIfItsSourceIs) {
  EXPECT_TRUE(checked(true).live());
  EXPECT_FALSE(checked(false).live());
}

TEST_F(CheckedSourceTest, MovesFramesThatComeAtTheSameTime) {
  CheckedSource source = checked(false);
  EXPECT_EQ(source.next()->time, 7);
  const Frame second = *source.next();
  EXPECT_DOUBLE_EQ(second.time, 7.1);
  EXPECT_EQ(second.fault, FrameFault::time_back);
}

}  // namespace
}  // namespace hypotrack
