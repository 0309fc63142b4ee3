#include "track/rig/delay_fit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "textured_pair.hpp"
#include "track/rig/rig_watch.hpp"

namespace hypotrack {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr double kFrame = 1.0 / 30;

/// Motions of a hand that goes up and down, measured in every other frame.
struct Motions {
  double delay = 0;       ///< seconds
  double amplitude = 1;   ///< of the speed
  double noise = 0.002;   ///< of the rows
  double offset = 0.003;  ///< of the rows

  RowMotion at(int i) {
    const double time = 2 * i * kFrame, speed = amplitude * std::sin(4 * time);
    return {time, speed, offset - delay * speed + random.gaussian(noise)};
  }
  cv::RNG random{1};
};

TEST(DelayFit, TellsTheDelayOfEitherView) {
  for (const double delay : {kFrame, 2 * kFrame, -kFrame}) {
    Motions motions{.delay = delay};
    DelayFit fit;
    for (int i = 0; i < 20; ++i) fit.add(motions.at(i));
    const auto found = fit.beyond(kFrame / 2);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->seconds, delay, 0.1 * kFrame);
    EXPECT_LT(found->sigma, 0.1 * kFrame);
  }
}

TEST(DelayFit, SaysNothingOfPicturesOfOneMoment) {
  Motions motions{.noise = 0.01};
  DelayFit fit;
  for (int i = 0; i < 200; ++i) {
    fit.add(motions.at(i));
    EXPECT_FALSE(fit.beyond(kFrame / 2)) << "frame " << i;
  }
}

TEST(DelayFit, SaysNothingOfHandsThatHardlyMove) {
  Motions motions{.delay = kFrame, .amplitude = 0.01};
  DelayFit fit;
  for (int i = 0; i < 200; ++i) {
    fit.add(motions.at(i));
    EXPECT_FALSE(fit.beyond(kFrame / 2)) << "frame " << i;
  }
}

TEST(DelayFit, SaysNothingOfOneStrokeThatIsMeasuredWrongly) {
  Motions motions;
  DelayFit fit;
  for (int i = 0; i < 60; ++i) {
    RowMotion motion = motions.at(i);
    if (i >= 20 && i < 26) motion.rows = -0.1 * motion.speed;
    fit.add(motion);
    EXPECT_FALSE(fit.beyond(kFrame / 2)) << "frame " << i;
  }
}

TEST(DelayFit, ALateViewIsSaidOnceAndForgottenWhenItEnds) {
  const test::TexturedPair pair;
  RigWatch watch = RigWatch::make(pair.cameras).value();
  Frame frame = pair.frame(300);
  Motions late{.delay = kFrame}, sound;
  for (int i = 0; i < 150; ++i) {
    for (int half = 0; half < 2; ++half) {
      frame.time = (2 * i + half) * kFrame;
      watch.look(frame);
    }
    watch.look_at_motion(2 * i, i < 30 ? late.at(i) : sound.at(i));
    if (i == 29) {
      EXPECT_TRUE(watch.is_doubtful());
      EXPECT_THAT(watch.take_notes(), ElementsAre(HasSubstr("the second view is late, by 3")));
    }
  }
  EXPECT_FALSE(watch.is_doubtful());
  EXPECT_TRUE(watch.take_notes().empty());
}

}  // namespace
}  // namespace hypotrack
