#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "expect_error.hpp"
#include "hypotrack/plugin/kinematics.hpp"
#include "output_run.hpp"
#include "test_models.hpp"

namespace hypotrack {
namespace {

using test::message_of;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

std::shared_ptr<const Model> box() { return std::make_shared<Model>(test::make_test_box()); }

class TumTest : public ::testing::Test {
 protected:
  const Scene scene_{{{"hand", std::make_shared<Model>(test::make_test_hand())}, {"box", box()}}};
  test::OutputRun run_{scene_};
};

TEST_F(TumTest, ALineIsTimePositionAndQuaternionWithWLast) {
  const std::vector<Solution> solutions = test::random_solutions(scene_, 2);
  run_.play("type: tum", solutions);
  const auto lines = run_.lines("box.tum");
  ASSERT_THAT(lines, SizeIs(2));
  std::stringstream line(lines[1]);
  double time = 0, x = 0, y = 0, z = 0, w = 0;
  Eigen::Vector3d at;
  line >> time >> at.x() >> at.y() >> at.z() >> x >> y >> z >> w;
  ASSERT_TRUE(line);
  EXPECT_EQ(time, solutions[1].time);
  const Eigen::Isometry3d truth =
      world_from_model(scene_.part(scene_.items()[1], solutions[1].state));
  EXPECT_EQ(at, Eigen::Vector3d(truth.translation()));
  EXPECT_TRUE(Eigen::Quaterniond(w, x, y, z).toRotationMatrix().isApprox(truth.linear(), 1e-12));
}

TEST_F(TumTest, FramesInWhichAModelIsNotSeenAreLeftOutOfItsFileOnly) {
  std::vector<Solution> solutions = test::random_solutions(scene_, 5);
  test::set_status(solutions[1], 1, Status::lost);
  test::set_status(solutions[2], 1, Status::absent);
  test::set_status(solutions[3], 1, Status::missing);
  test::set_status(solutions[4], 1, Status::uncertain);
  run_.play("type: tum", solutions);
  EXPECT_THAT(run_.lines("hand.tum"), SizeIs(5));
  EXPECT_THAT(run_.lines("box.tum"),
              ElementsAre(::testing::StartsWith("0 "), ::testing::StartsWith("0.13333")));
}

TEST_F(TumTest, TimesAreTheStampsOfTheRecordingToTheLastDigit) {
  run_.stamp = 1403636579763555584;
  run_.play("type: tum", test::random_solutions(scene_, 2));
  EXPECT_THAT(run_.lines("hand.tum"), ElementsAre(::testing::StartsWith("1403636579.763555584 "),
                                                  ::testing::StartsWith("1403636579.763555585 ")));
}

TEST_F(TumTest, ModelsWhoseNamesAreNoFileNamesAreRefused) {
  for (const std::string name : {"left/hand", "hand#1", "", ".hand", "a\nb"}) {
    const Scene scene{{{name, box()}}};
    const test::OutputRun run(scene);
    for (const std::string type : {"tum", "bvh"})
      EXPECT_THAT(message_of<ConfigError>([&] { run.open("type: " + type); }),
                  AllOf(HasSubstr("models: the name '" + name + "' cannot be that of a ." + type),
                        HasSubstr("another `name`")));
  }
}

}  // namespace
}  // namespace hypotrack
