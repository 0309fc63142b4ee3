#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/subprocess.hpp"
#include "hypotrack/plugin/kinematics.hpp"
#include "imported_motion.hpp"
#include "output_run.hpp"
#include "test_models.hpp"

namespace hypotrack {
namespace {

using test::ImportedMotion;

/// Returns a point of the world in the axes of the file.
Eigen::Vector3d turned(const Eigen::Vector3d& p) { return {p.x(), -p.y(), -p.z()}; }

/// Expects every bone of a model where the file has its joint, to 0.1 mm.
void expect_bones(const ImportedMotion& motion, double ticks, const Model& model,
                  std::span<const double> parameters) {
  constexpr double kTolerance = 1e-4;
  const auto nodes = motion.nodes_at(ticks);
  const auto bones = world_from_bones(model.data(), parameters);
  for (std::size_t b = 0; b < bones.size(); ++b) {
    const std::string& name = model.data().bones[b].name;
    ASSERT_TRUE(nodes.contains(name)) << name;
    const Eigen::Vector3d expected = turned(bones[b].translation());
    EXPECT_LT((nodes.at(name).translation() - expected).norm(), kTolerance) << name;
  }
}

void expect_motion(test::OutputRun& run, const Scene& scene,
                   const std::vector<Solution>& solutions) {
  run.play("type: bvh", solutions);
  for (const Scene::Item& item : scene.items()) {
    const ImportedMotion motion(run.file(item.name + ".bvh"));
    EXPECT_NEAR(motion.ticks_per_second(), 30, 1e-4);
    for (std::size_t i = 0; i < solutions.size(); ++i) {
      SCOPED_TRACE(item.name + ", frame " + std::to_string(i));
      expect_bones(motion, static_cast<double>(i), *item.model,
                   scene.part(item, solutions[i].state));
    }
  }
}

TEST(Bvh, JointsAreWhereTheBonesOfRealHandsAndABoxAre) {
  const auto scene = test::make_scene({{"right", "type: hand"},
                                       {"left", "type: mirrored_hand"},
                                       {"box", "{type: rigid_box, size_mm: [60, 90, 40]}"}});
  test::OutputRun run(*scene);
  expect_motion(run, *scene, test::random_solutions(*scene, 8));
}

TEST(Bvh, JointsOfAllKindsAreWhereTheBonesAre) {
  const Scene scene({{"cabinet", std::make_shared<Model>(test::make_test_cabinet())}});
  test::OutputRun run(scene);
  expect_motion(run, scene, test::random_solutions(scene, 8));
}

/// Expects every bone where three.js has its joint, to 0.1 mm: it adds OFFSET to the positions.
void expect_bones_in_three_js(const nlohmann::json& joints, const Model& model,
                              std::span<const double> parameters) {
  constexpr double kTolerance = 1e-4;
  const auto bones = world_from_bones(model.data(), parameters);
  for (std::size_t b = 0; b < bones.size(); ++b) {
    const std::string& name = model.data().bones[b].name;
    ASSERT_TRUE(joints.contains(name)) << name;
    const Eigen::Vector3d there(joints[name][0], joints[name][1], joints[name][2]);
    EXPECT_LT((there - turned(bones[b].translation())).norm(), kTolerance) << name;
  }
}

TEST(Bvh, JointsAreWhereTheBonesAreInThreeJs) {
  const std::filesystem::path node = HYPOTRACK_NODE, three = HYPOTRACK_THREE_DIR;
  if (!exists(node) || !exists(three / "examples/js/loaders/BVHLoader.js"))
    GTEST_SKIP() << "needs nodejs and libjs-three";
  const Scene scene({{"cabinet", std::make_shared<Model>(test::make_test_cabinet())},
                     {"hand", std::make_shared<Model>(test::make_test_hand())}});
  test::OutputRun run(scene);
  const std::vector<Solution> solutions = test::random_solutions(scene, 4);
  run.play("type: bvh", solutions);
  for (const Scene::Item& item : scene.items()) {
    const Captured said = capture_output(
        {node, {HYPOTRACK_BVH_SCRIPT, three.string(), run.file(item.name + ".bvh").string()}}, {1});
    const auto frames = nlohmann::json::parse(said.output);
    ASSERT_EQ(frames.size(), solutions.size());
    // The last frame would be interpolated with the first, where an animation ends.
    for (std::size_t i = 0; i + 1 < solutions.size(); ++i) {
      SCOPED_TRACE(item.name + ", frame " + std::to_string(i));
      expect_bones_in_three_js(frames[i], *item.model, scene.part(item, solutions[i].state));
    }
  }
}

TEST(Bvh, EndsOfFingersAreWhereTheLandmarksAre) {
  const auto scene = test::make_scene({{"hand", "type: hand"}});
  test::OutputRun run(*scene);
  const std::vector<Solution> solutions = test::random_solutions(*scene, 3);
  run.play("type: bvh", solutions);
  const ImportedMotion motion(run.file("hand.bvh"));
  const auto nodes = motion.nodes_at(2);
  const auto& landmarks = scene->items()[0].model->data().landmarks;
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    if (!landmarks[i].name.ends_with("_tip")) continue;
    const Eigen::Vector3d expected =
        turned(solutions[2].landmarks.col(static_cast<Eigen::Index>(i)));
    double nearest = 1;
    for (const auto& [name, node] : nodes)
      nearest = std::min(nearest, (node.translation() - expected).norm());
    EXPECT_LT(nearest, 1e-4) << landmarks[i].name;
  }
}

TEST(Bvh, AModelWithSeveralRootBonesGetsOneAboveThem) {
  ModelData data = test::make_test_box();
  Bone lid{.name = "the lid {1}"};
  lid.parent_from_bone.translation() << 0.01, 0.02, 0.03;
  lid.parent_from_bone.rotate(Eigen::AngleAxisd(1, Eigen::Vector3d::UnitX()));
  data.bones.push_back(lid);
  const Scene scene{{{"box", std::make_shared<Model>(data)}}};
  test::OutputRun run(scene);
  const std::vector<Solution> solutions = test::random_solutions(scene, 2);
  run.play("type: bvh", solutions);
  const auto nodes = ImportedMotion(run.file("box.bvh")).nodes_at(1);
  const auto bones = world_from_bones(data, scene.part(scene.items()[0], solutions[1].state));
  EXPECT_LT((nodes.at("the_lid__1_").translation() - turned(bones[1].translation())).norm(), 1e-4);
  const auto root = world_from_model(scene.part(scene.items()[0], solutions[1].state));
  EXPECT_LT((nodes.at("box").translation() - turned(root.translation())).norm(), 1e-4);
}

class BvhBoxTest : public ::testing::Test {
 protected:
  /// Returns the numbers of a frame in the file.
  std::vector<double> numbers(std::size_t frame) const {
    const auto lines = run_.lines("box.bvh");
    const auto motion = std::ranges::find(lines, "MOTION");
    std::stringstream line(*(motion + 3 + static_cast<std::ptrdiff_t>(frame)));
    return {std::istream_iterator<double>(line), {}};
  }
  Solution turned_about_y(int frame, double degrees) const {
    Eigen::VectorXd state = scene_.rest_state();
    const Eigen::Quaterniond q(Eigen::AngleAxisd(degrees * kDegree, Eigen::Vector3d::UnitY()));
    state.segment<4>(3) << q.w(), q.x(), q.y(), q.z();
    return test::tracked(scene_, frame, state);
  }

  std::span<const double> span_of(const Solution& solution) const {
    return scene_.part(scene_.items()[0], solution.state);
  }

  const Scene scene_{{{"box", std::make_shared<Model>(test::make_test_box())}}};
  test::OutputRun run_{scene_};
};

TEST_F(BvhBoxTest, AnglesDoNotJumpOverSeveralTurnsAboutAnyAxis) {
  constexpr double kJump = 90;  // degrees; steps of 10 are large angles where z and y nearly align
  for (const Eigen::Vector3d& axis : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0),
                                      Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(1, 0.3, -0.2)}) {
    std::vector<Solution> solutions;
    for (int i = 0; i < 100; ++i) {
      Eigen::VectorXd state = scene_.rest_state();
      const Eigen::Quaterniond q(Eigen::AngleAxisd(10 * i * kDegree, axis.normalized()));
      state.segment<4>(3) << q.w(), q.x(), q.y(), q.z();
      solutions.push_back(test::tracked(scene_, i, state));
    }
    run_.play("type: bvh", solutions);
    std::vector<double> last = numbers(0);
    for (std::size_t i = 1; i < solutions.size(); ++i) {
      const std::vector<double> now = numbers(i);
      for (std::size_t k = 3; k < 6; ++k)
        EXPECT_LT(std::abs(now[k] - last[k]), kJump) << "frame " << i << " of " << axis.transpose();
      last = now;
    }
    const ImportedMotion motion(run_.file("box.bvh"));
    const Eigen::Isometry3d file_from_box =
        motion.nodes_at(99).at(scene_.items()[0].model->data().bones[0].name);
    const Eigen::Matrix3d turn = Eigen::Vector3d(1, -1, -1).asDiagonal();
    EXPECT_LT((file_from_box.linear() - turn * world_from_model(span_of(solutions.back())).linear())
                  .norm(),
              1e-5);
  }
}

TEST_F(BvhBoxTest, AModelThatIsNotSeenKeepsItsLastPose) {
  std::vector<Solution> solutions;
  for (int i = 0; i < 5; ++i) solutions.push_back(turned_about_y(i, 20 * i));
  test::set_status(solutions[2], 0, Status::lost);
  test::set_status(solutions[3], 0, Status::absent);
  run_.play("type: bvh", solutions);
  EXPECT_EQ(numbers(2), numbers(1));
  EXPECT_EQ(numbers(3), numbers(1));
  EXPECT_NE(numbers(4), numbers(1));
}

TEST_F(BvhBoxTest, FramesAreOnTheLinesOfTheirTimes) {
  const std::vector<double> times = {2.0, 2.04, 2.045, 2.16};  // lines 0, 1, 1 and 5
  std::vector<Solution> solutions;
  for (std::size_t i = 0; i < times.size(); ++i) {
    solutions.push_back(turned_about_y(static_cast<int>(i), 20.0 * static_cast<double>(i)));
    solutions.back().time = times[i];
  }
  run_.play("type: bvh", solutions);
  EXPECT_THAT(run_.text("box.bvh"), ::testing::HasSubstr("\nFrames:          6\n"));
  const auto turn_of_line = [&](std::size_t line) {
    const ImportedMotion motion(run_.file("box.bvh"));
    const auto nodes = motion.nodes_at(static_cast<double>(line));
    const Eigen::Matrix3d upside_down = Eigen::Vector3d(1, -1, -1).asDiagonal();
    return Eigen::AngleAxisd(upside_down *
                             nodes.at(scene_.items()[0].model->data().bones[0].name).linear())
               .angle() /
           kDegree;
  };
  constexpr double kTolerance = 1e-3;
  EXPECT_NEAR(turn_of_line(0), 0, 0.1);
  EXPECT_NEAR(turn_of_line(1), 20, kTolerance);
  for (const std::size_t line : {2U, 3U, 4U}) EXPECT_NEAR(turn_of_line(line), 40, kTolerance);
  EXPECT_NEAR(turn_of_line(5), 60, kTolerance);
}

TEST_F(BvhBoxTest, ALongerGapThanAMinuteBecomesAMinute) {
  std::vector<Solution> solutions{turned_about_y(0, 0), turned_about_y(1, 20)};
  solutions[1].time = 1e9;
  run_.play("type: bvh", solutions);
  EXPECT_THAT(run_.text("box.bvh"), ::testing::HasSubstr("\nFrames:       1802\n"));
}

TEST_F(BvhBoxTest, AnInterruptedOrKilledRunLeavesAWholeFile) {
  std::vector<Solution> solutions;
  for (int i = 0; i < 3; ++i) solutions.push_back(turned_about_y(i, 20 * i));
  run_.play("type: bvh", solutions, false);
  const std::string whole = run_.text("box.bvh");
  EXPECT_THAT(whole, ::testing::HasSubstr("\nFrames:          3\nFrame Time: 0.0333333333\n"));
  run_.play_killed("type: bvh", solutions);
  EXPECT_EQ(run_.text("box.bvh"), whole);
}

}  // namespace
}  // namespace hypotrack
