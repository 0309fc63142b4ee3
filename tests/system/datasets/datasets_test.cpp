// The motions of configs/scenes/datasets: as long as the paper's, no faster than its search can
// follow (one a little faster), in view, and without bodies that pass through each other. So are
// those of other scenes that trackers are chosen on.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "dataset.hpp"
#include "hypotrack/api/camera.hpp"
#include "hypotrack/plugin/params.hpp"
#include "output/metrics/motion_speeds.hpp"
#include "penetration.hpp"

namespace hypotrack::test {
namespace {

// Skin and flesh give way by some millimetres where a hand presses on something.
constexpr double kPressed = 2e-3;         // on another hand or a box
constexpr double kPressedFingers = 4e-3;  // of one hand, on each other
constexpr int kStep = 3;                  // frames

class Motion : public testing::TestWithParam<std::pair<const char*, int>> {};
class PapersMotion : public Motion {};

TEST_P(PapersMotion, HasTheLengthOfThePapers) {
  EXPECT_EQ(load_dataset(GetParam().first).states.size(), GetParam().second);
}

TEST_P(PapersMotion,
       is_as_fast_as_people_and_no_faster_than_a_search_around_the_last_pose_can_follow) {
  const Dataset dataset = load_dataset(GetParam().first);
  for (const ModelSpeeds& speeds : motion_speeds(dataset.scene, dataset.states)) {
    EXPECT_LT(speeds.translation.peak, 6.6e-3) << motion_text({&speeds, 1});
    EXPECT_LT(speeds.rotation.peak, 2.2 * kDegree) << motion_text({&speeds, 1});
    EXPECT_LT(speeds.joints.peak, 7 * kDegree) << motion_text({&speeds, 1});
    EXPECT_GT(speeds.translation.peak, 4e-3) << motion_text({&speeds, 1});
  }
}

TEST_P(Motion, StaysWithinTheModelsBoundsAndBothViews) {
  const Dataset dataset = load_dataset(GetParam().first);
  constexpr double kFocal = 700, kBaseline = 0.12, kMargin = 10;
  for (const StateRow& row : dataset.states) {
    ASSERT_NO_THROW(dataset.scene.check(row.state, fmt::format("frame {}", row.frame)));
    const Eigen::Matrix3Xd points = dataset.scene.landmarks(row.state);
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      const Eigen::Vector3d p = points.col(i);
      ASSERT_GT(p.z(), 0.25) << row.frame;
      for (const double x : {p.x(), p.x() - kBaseline})
        ASSERT_LT(std::abs(kFocal * x / p.z()), 640 - kMargin) << "frame " << row.frame;
      ASSERT_LT(std::abs(kFocal * p.y() / p.z()), 360 - kMargin) << "frame " << row.frame;
    }
  }
}

TEST_P(Motion, PutsNoFingerThroughAnother) {
  const Dataset dataset = load_dataset(GetParam().first);
  for (std::size_t m = 0; m < dataset.scene.items().size(); ++m) {
    const ModelData& model = dataset.scene.items()[m].model->data();
    if (model.parameters.size() == 7) continue;
    const std::vector<HandPart> parts = hand_parts(model);
    for (int f = 0; f < GetParam().second; f += kStep)
      EXPECT_LT(self_penetration(parts, vertices(dataset, m, f)), kPressedFingers)
          << dataset.scene.items()[m].name << " in frame " << f;
  }
}

const auto kPapers = testing::Values(std::pair("datasets/sh", 638), std::pair("datasets/ho", 545),
                                     std::pair("datasets/th", 705));
const auto kName = [](const auto& test) {
  return std::filesystem::path(test.param.first).stem().string();
};
INSTANTIATE_TEST_SUITE_P(Datasets, PapersMotion, kPapers, kName);
INSTANTIATE_TEST_SUITE_P(Datasets, Motion, kPapers, kName);
INSTANTIATE_TEST_SUITE_P(FastHand, Motion, testing::Values(std::pair("datasets/shf", 376)), kName);
INSTANTIATE_TEST_SUITE_P(Tuning, Motion,
                         testing::Values(std::pair("tuning/two_hands_cross", 360),
                                         std::pair("tuning/turning_hand", 521),
                                         std::pair("tuning/turning_hand_2", 567),
                                         std::pair("hand_and_box", 110)),
                         kName);

TEST(FastHand, BendsItsFingersByElevenDegreesPerFrame) {
  const Dataset dataset = load_dataset("datasets/shf");
  ASSERT_EQ(dataset.states.size(), 376);
  const auto speeds = motion_speeds(dataset.scene, dataset.states);
  EXPECT_NEAR(speeds[0].joints.peak, 11 * kDegree, 0.5 * kDegree) << motion_text(speeds);
  EXPECT_NEAR(speeds[0].translation.peak, 9.3e-3, 0.5e-3) << motion_text(speeds);
}

/// How deep two models lie in each other.
double penetration_between(const Dataset& dataset, int frame) {
  const Eigen::Matrix3Xf a = vertices(dataset, 0, frame), b = vertices(dataset, 1, frame);
  const auto& items = dataset.scene.items();
  return std::max(penetration(a, b, items[1].model->data().mesh.triangles),
                  penetration(b, a, items[0].model->data().mesh.triangles));
}

double clearance_between(const Dataset& dataset, int frame) {
  return clearance(vertices(dataset, 0, frame), vertices(dataset, 1, frame),
                   dataset.scene.items()[1].model->data().mesh.triangles);
}

TEST(HandAndObject, TheHandIsNeverInsideTheBoxAndTouchesItWhileItHoldsIt) {
  const Dataset dataset = load_dataset("datasets/ho");
  for (int f = 0; f < 545; f += kStep)
    EXPECT_LT(penetration_between(dataset, f), kPressed) << "frame " << f;
  for (const int f : {60, 112, 190, 256, 346, 446, 500, 544})
    EXPECT_LT(clearance_between(dataset, f), 1e-3) << "frame " << f;
  for (const int f : {0, 390}) EXPECT_GT(clearance_between(dataset, f), 10e-3) << "frame " << f;
}

TEST(HandAndObject, TheHandOfTheShortSceneIsNeverInsideTheBoxAndHoldsIt) {
  const Dataset dataset = load_dataset("hand_and_box");
  for (int f = 0; f < 110; f += kStep) {
    EXPECT_LT(penetration_between(dataset, f), kPressed) << "frame " << f;
    EXPECT_LT(clearance_between(dataset, f), 1e-3) << "frame " << f;
  }
}

TEST(HandAndObject, TheBoxMovesOnlyWithTheHand) {
  const Dataset dataset = load_dataset("datasets/ho");
  const int offset = dataset.scene.items()[1].offset;
  const auto box = [&](int frame) -> Eigen::Vector3d {
    return dataset.states[static_cast<std::size_t>(frame)].state.segment<3>(offset);
  };
  EXPECT_LT((box(60) - box(0)).norm(), 1e-9);
  EXPECT_LT((box(446) - box(352)).norm(), 1e-9);
  EXPECT_GT((box(190) - box(60)).norm(), 0.1);
  EXPECT_GT((box(544) - box(446)).norm(), 0.1);
}

TEST(TwoHands, NeverPassThroughEachOther) {
  for (const char* name : {"datasets/th", "tuning/two_hands_cross"}) {
    const Dataset dataset = load_dataset(name);
    for (int f = 0; f < static_cast<int>(dataset.states.size()); f += kStep)
      EXPECT_LT(penetration_between(dataset, f), kPressed) << name << ", frame " << f;
  }
}

TEST(TwoHands, TouchWithFingertipsPalmsAFingerAndAFist) {
  const Dataset dataset = load_dataset("datasets/th");
  for (const int f : {340, 415, 430, 526, 618})
    EXPECT_LT(clearance_between(dataset, f), 1.5e-3) << "frame " << f;
}

TEST(TwoHands, HideEachOther) {
  const Dataset dataset = load_dataset("datasets/th");
  // In the middle of each crossing the palms lie behind each other as the camera sees them.
  for (const int f : {102, 236}) {
    const Eigen::Matrix3Xd points =
        dataset.scene.landmarks(dataset.states[static_cast<std::size_t>(f)].state);
    const Eigen::Vector3d right = points.leftCols(21).rowwise().mean();
    const Eigen::Vector3d left = points.rightCols(21).rowwise().mean();
    EXPECT_LT((700 * right / right.z() - 700 * left / left.z()).norm(), 80) << f;
    EXPECT_GT(std::abs(right.z() - left.z()), 0.08) << f;
  }
}

}  // namespace
}  // namespace hypotrack::test
