#include "motion/motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace hypotrack::synthetic {
namespace {

NumberTrack number_track(const std::vector<double>& times, const std::vector<double>& values) {
  NumberTrack track;
  for (std::size_t i = 0; i < times.size(); ++i) track.add(times[i], values[i]);
  return track;
}

const std::vector<double> kTimes = {0.5, 1.0, 1.3, 2.0, 2.2, 3.0};

TEST(NumberTrack, PassesThroughItsKeysAndHoldsTheEnds) {
  const std::vector<double> values = {1, 2, 5, 4.5, -1, 3};
  const NumberTrack track = number_track(kTimes, values);
  for (std::size_t i = 0; i < values.size(); ++i)
    EXPECT_NEAR(track.at(kTimes[i]), values[i], 1e-12);
  EXPECT_EQ(track.at(-3), 1);
  EXPECT_EQ(track.at(99), 3);
}

TEST(NumberTrack, NeverLeavesTheRangeOfTheKeysAroundIt) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<double> values(kTimes.size());
    for (double& v : values) v = normal(random);
    const NumberTrack track = number_track(kTimes, values);
    for (std::size_t i = 0; i + 1 < kTimes.size(); ++i) {
      const auto [low, high] = std::minmax(values[i], values[i + 1]);
      for (int k = 0; k <= 50; ++k) {
        const double v = track.at(kTimes[i] + (kTimes[i + 1] - kTimes[i]) * k / 50);
        EXPECT_GE(v, low - 1e-12);
        EXPECT_LE(v, high + 1e-12);
      }
    }
  }
}

TEST(NumberTrack, ChangesSpeedWithoutStepsAndRestsAtTheEnds) {
  const NumberTrack track = number_track(kTimes, {0, 1, 3, 4, 4.2, 9});
  constexpr double kStep = 1e-6;
  const auto speed = [&](double t) {
    return (track.at(t + kStep) - track.at(t - kStep)) / (2 * kStep);
  };
  for (const double t : kTimes) EXPECT_NEAR(speed(t - 2 * kStep), speed(t + 2 * kStep), 1e-3) << t;
  EXPECT_NEAR(speed(0.5 + 2 * kStep), 0, 1e-3);
  EXPECT_NEAR(speed(3.0 - 2 * kStep), 0, 1e-3);
  EXPECT_GT(speed(1.3), 0.5) << "a track that only ascends does not stop at its keys";
}

TEST(NumberTrack, StaysAtItsOnlyKey) {
  const NumberTrack track = number_track({1.0}, {7.0});
  for (const double t : {0.0, 1.0, 2.0}) EXPECT_EQ(track.at(t), 7.0);
}

std::vector<Eigen::Quaterniond> some_rotations() {
  std::vector<Eigen::Quaterniond> rotations;
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  for (std::size_t i = 0; i < kTimes.size(); ++i) {
    rotations.emplace_back(normal(random), normal(random), normal(random), normal(random));
    rotations.back().normalize();
  }
  return rotations;
}

RotationTrack rotation_track(const std::vector<Eigen::Quaterniond>& rotations) {
  RotationTrack track;
  for (std::size_t i = 0; i < rotations.size(); ++i) track.add(kTimes[i], rotations[i]);
  return track;
}

TEST(RotationTrack, PassesThroughItsKeysAndHoldsTheEnds) {
  const auto rotations = some_rotations();
  const RotationTrack track = rotation_track(rotations);
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    EXPECT_LT(track.at(kTimes[i]).angularDistance(rotations[i]), 1e-7);
  }
  EXPECT_LT(track.at(-1).angularDistance(rotations.front()), 1e-7);
  EXPECT_LT(track.at(9).angularDistance(rotations.back()), 1e-7);
}

TEST(RotationTrack, MovesWithoutJumpsInRotationSignOrSpeed) {
  const RotationTrack track = rotation_track(some_rotations());
  constexpr double kStep = 1e-5;
  const auto velocity = [&](double t) -> Eigen::Vector3d {
    const Eigen::AngleAxisd step(track.at(t - kStep).conjugate() * track.at(t + kStep));
    return step.angle() * step.axis() / (2 * kStep);
  };
  Eigen::Quaterniond former = track.at(0);
  for (double t = 0.01; t < 3.2; t += 0.01) {
    const Eigen::Quaterniond q = track.at(t);
    EXPECT_NEAR(q.norm(), 1, 1e-12);
    EXPECT_GT(q.dot(former), 0.9) << "at " << t;
    former = q;
  }
  for (const double t : kTimes) {
    EXPECT_LT((velocity(t - 2 * kStep) - velocity(t + 2 * kStep)).norm(), 0.02) << "at " << t;
  }
  EXPECT_LT(velocity(kTimes.front()).norm(), 0.02);
}

TEST(RotationTrack, TurnsAboutTheAxisBetweenTwoKeys) {
  RotationTrack track;
  const Eigen::Vector3d axis = Eigen::Vector3d(1, -2, 0.5).normalized();
  track.add(0, Eigen::Quaterniond::Identity());
  track.add(1, Eigen::Quaterniond(Eigen::AngleAxisd(1.2, axis)));
  const Eigen::Quaterniond half(Eigen::AngleAxisd(0.6, axis));
  EXPECT_LT(track.at(0.5).angularDistance(half), 1e-9);
}

}  // namespace
}  // namespace hypotrack::synthetic
