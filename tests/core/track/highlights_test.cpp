#include "track/color/highlights.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace hypotrack {
namespace {

const ViewDirections kTo{Eigen::Vector3d(-0.12, 0, -1).normalized(),
                         Eigen::Vector3d(0.12, 0, -1).normalized()};

/// What a light's highlight makes the views differ by, by Blinn's model.
Eigen::VectorXf seen(const Eigen::Matrix3Xf& normals, const Eigen::Vector3d& light,
                     double shininess, double strength = 60) {
  const auto highlight = [&](Eigen::Index i, const Eigen::Vector3d& to) {
    const Eigen::Vector3d half = (light.normalized() + to).normalized();
    return strength * std::pow(std::max(half.dot(normals.col(i).cast<double>()), 0.0), shininess);
  };
  Eigen::VectorXf out(normals.cols());
  for (Eigen::Index i = 0; i < out.size(); ++i)
    out[i] = static_cast<float>(highlight(i, kTo.first) - highlight(i, kTo.other));
  return out;
}

/// Normals that both cameras may see.
Eigen::Matrix3Xf some_normals(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal;
  Eigen::Matrix3Xf out(3, count);
  for (int i = 0; i < count; ++i) {
    out.col(i) << normal(random), normal(random), normal(random) - 1.5F;
    out(2, i) = -std::abs(out(2, i));
  }
  return out.colwise().normalized();
}

struct Case {
  Eigen::Vector3d light;
  double shininess;
};

TEST(Highlights, ExpectsNothingBeforeItHasLearned) {
  EXPECT_EQ(Highlights().expected(some_normals(20, 1), kTo).norm(), 0);
}

TEST(Highlights, FindsLightsAnywhereFromNoisySamples) {
  std::mt19937 random(3);
  std::normal_distribution<float> noise(0, 5);
  for (const Case& c : {Case{{0.3, 0.5, -1}, 25}, Case{{-0.8, 0.1, -0.5}, 25},
                        Case{{0.1, -0.6, -0.8}, 12}, Case{{0.35, 0.6, -1}, 40}}) {
    Highlights highlights;
    for (unsigned frame = 0; frame < 10; ++frame) {
      const Eigen::Matrix3Xf normals = some_normals(500, 10 + frame);
      Eigen::VectorXf differences = seen(normals, c.light, c.shininess);
      for (float& d : differences) d += noise(random);
      highlights.learn(normals, differences, kTo);
    }
    const Eigen::Matrix3Xf others = some_normals(500, 5);
    const Eigen::VectorXf truth = seen(others, c.light, c.shininess);
    EXPECT_LT((highlights.expected(others, kTo) - truth).norm(), 0.3 * truth.norm())
        << c.light.transpose() << ", " << c.shininess;
  }
}

TEST(Highlights, TakesNoiseForNoLight) {
  std::mt19937 random(3);
  std::normal_distribution<float> noise(0, 5);
  Highlights highlights;
  for (unsigned frame = 0; frame < 20; ++frame) {
    Eigen::VectorXf differences(500);
    for (float& d : differences) d = noise(random);
    highlights.learn(some_normals(500, 10 + frame), differences, kTo);
  }
  const Eigen::VectorXf expected = highlights.expected(some_normals(500, 5), kTo);
  EXPECT_LT(expected.norm() / std::sqrt(500.0F), 1);
}

TEST(Highlights, KnowsTheOtherHalfOfAHighlightFromOne) {
  Highlights highlights;
  const Eigen::Vector3d light(0, 0, -1);
  const Eigen::Matrix3Xf all = some_normals(4000, 1);
  Eigen::Matrix3Xf half(3, 0), rest(3, 0);
  for (Eigen::Index i = 0; i < all.cols(); ++i) {
    Eigen::Matrix3Xf& side = all(0, i) < 0 ? half : rest;
    side.conservativeResize(3, side.cols() + 1);
    side.rightCols<1>() = all.col(i);
  }
  for (int frame = 0; frame < 5; ++frame) highlights.learn(half, seen(half, light, 25), kTo);
  const Eigen::VectorXf truth = seen(rest, light, 25);
  EXPECT_LT((highlights.expected(rest, kTo) - truth).norm(), 0.5 * truth.norm());
}

TEST(Highlights, FollowsALightThatMoves) {
  Highlights highlights;
  const Eigen::Matrix3Xf normals = some_normals(500, 1);
  for (int frame = 0; frame < 30; ++frame)
    highlights.learn(normals, seen(normals, {0.5, 0.5, -1}, 25), kTo);
  const Eigen::VectorXf truth = seen(normals, {-0.5, 0.2, -1}, 25);
  for (int frame = 0; frame < 60; ++frame) highlights.learn(normals, truth, kTo);
  EXPECT_LT((highlights.expected(normals, kTo) - truth).norm(), 0.35 * truth.norm());
}

TEST(Highlights, CountsAllCallsAlikeWhereNothingFades) {
  const Eigen::Matrix3Xf normals = some_normals(500, 1);
  const Eigen::VectorXf first = seen(normals, {0.5, 0.5, -1}, 25, 10),
                        second = seen(normals, {-0.5, 0.2, -1}, 25, 10);
  const auto first_to_second = [&](Highlights highlights) {
    for (int frame = 0; frame < 40; ++frame) highlights.learn(normals, first, kTo);
    for (int frame = 0; frame < 40; ++frame) highlights.learn(normals, second, kTo);
    const Eigen::VectorXf expected = highlights.expected(normals, kTo);
    return expected.dot(first) / expected.dot(second);
  };
  EXPECT_NEAR(first_to_second(Highlights(1)), 1, 0.1);
  EXPECT_LT(first_to_second(Highlights()), 0.5);
}

TEST(Highlights, ForgetsNoLightBeforeItLearnsAnew) {
  Highlights highlights(1);
  const Eigen::Matrix3Xf normals = some_normals(500, 1);
  for (int frame = 0; frame < 10; ++frame)
    highlights.learn(normals, seen(normals, {0.5, 0.5, -1}, 25), kTo);
  const Eigen::VectorXf before = highlights.expected(normals, kTo);
  highlights.forget();
  EXPECT_EQ(highlights.expected(normals, kTo), before);
  const Eigen::VectorXf other = seen(normals, {-0.5, 0.2, -1}, 25);
  for (int frame = 0; frame < 10; ++frame) highlights.learn(normals, other, kTo);
  EXPECT_LT((highlights.expected(normals, kTo) - other).norm(), 0.3 * other.norm());
}

}  // namespace
}  // namespace hypotrack
