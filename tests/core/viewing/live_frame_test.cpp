#include "viewing/live_frame.hpp"

#include <gtest/gtest.h>

#include "live_world.hpp"
#include "viewing/frame_rate.hpp"

namespace hypotrack::test {
namespace {

TEST(LiveFrame, HidesModelsWhosePoseIsUnknown) {
  const LiveWorld world;
  for (const Status status : {Status::tracked, Status::uncertain})
    EXPECT_EQ(world.live(0, status).views->hidden, std::vector<bool>{false});
  for (const Status status : {Status::lost, Status::absent})
    EXPECT_EQ(world.live(0, status).views->hidden, std::vector<bool>{true});
}

TEST(LiveFrame, SharesThePicturesOfTheSource) {
  const LiveWorld world;
  const Frame frame = world.frame(3);
  const ShownViews shown = shown_views(frame, world.solution(3, Status::tracked, 1));
  EXPECT_EQ(shown.frame, 3);
  EXPECT_EQ(shown.images.at(1).data, frame.views[1].color.data);
}

TEST(LiveFrame, SigmaIsTheMeanOfAModelsLandmarks) {
  const LiveWorld world;
  Solution solution = world.solution(0, Status::tracked, 1);
  EXPECT_TRUE(std::isnan(model_sigmas(world.scene, solution).at(0)));
  const auto count = static_cast<Eigen::Index>(world.scene.landmark_names().size());
  solution.sigma = Eigen::VectorXd::LinSpaced(count, 0.001, 0.003);
  EXPECT_NEAR(model_sigmas(world.scene, solution).at(0), 0.002, 1e-12);
}

TEST(FrameRate, IsThatOfTheLastFrames) {
  FrameRate rate;
  const FrameRate::Clock::time_point begin{};
  rate.add(begin);
  EXPECT_TRUE(std::isnan(rate.per_second()));
  for (int i = 1; i <= 100; ++i) rate.add(begin + std::chrono::seconds(10 * i));
  for (int i = 1; i <= 30; ++i)
    rate.add(begin + std::chrono::seconds(1000) + std::chrono::milliseconds(20 * i));
  EXPECT_NEAR(rate.per_second(), 50, 1e-9);
  rate.clear();
  EXPECT_TRUE(std::isnan(rate.per_second()));
}

}  // namespace
}  // namespace hypotrack::test
