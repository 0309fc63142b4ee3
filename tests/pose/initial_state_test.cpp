#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <memory>

#include "hypotrack/error.hpp"
#include "hypotrack/params.hpp"
#include "hypotrack/tables.hpp"
#include "session/opened_scene.hpp"
#include "test_models.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

using testing::HasSubstr;

OpenedScene box_session() {
  OpenedScene session;
  session.scene =
      std::make_unique<Scene>(std::vector<std::pair<std::string, std::shared_ptr<const Model>>>{
          {"box", std::make_shared<Model>(test::make_test_box())}});
  return session;
}

std::string message_of(const OpenedScene& session, const Frame& frame) {
  try {
    initial_state(session, frame);
  } catch (const Error& e) {
    return e.what();
  }
  return "no error";
}

TEST(InitialState, IsTheRestStateChangedByThePose) {
  OpenedScene session = box_session();
  session.init.pose = ConfigNode::parse("{box: {position_mm: [10, 20, 500]}}", "test");
  const Eigen::VectorXd state = initial_state(session, {});
  EXPECT_NEAR(state[0], 0.010, 1e-12);
  EXPECT_NEAR(state[2], 0.500, 1e-12);
  EXPECT_EQ(state[3], 1);
}

TEST(InitialState, RefusesAPoseThatIsNone) {
  OpenedScene session = box_session();
  const auto message = [&](const std::string& pose) {
    session.init.pose = ConfigNode::parse("{box: {" + pose + "}}", "test");
    return message_of(session, {});
  };
  EXPECT_THAT(message("position_mm: [1, 2]"), HasSubstr("position_mm has 2 numbers, expected 3"));
  EXPECT_THAT(message("position_mm: []"), HasSubstr("position_mm has 0 numbers, expected 3"));
  EXPECT_THAT(message("position_mm: [.inf, 0, 0]"), HasSubstr("out of range"));
  EXPECT_THAT(message("rotation_deg: [0, -.inf, 0]"), HasSubstr("out of range"));
  EXPECT_THAT(message("quaternion: [.inf, 0, 0, 0]"), HasSubstr("out of range"));
  EXPECT_THAT(message("quaternion: [0, 0, 0, 0]"), HasSubstr("is no rotation"));
}

TEST(InitialState, IsTheTruthOfTheFirstFrame) {
  OpenedScene session = box_session();
  session.init.from = InitFrom::truth;
  Frame frame;
  EXPECT_THAT(message_of(session, frame), HasSubstr("the source knows no true state"));
  frame.truth = GroundTruth{session.scene->rest_state(), {}};
  frame.truth->state[1] = 0.25;
  EXPECT_EQ(initial_state(session, frame), frame.truth->state);
}

TEST(InitialState, IsAsFarAwayAsAskedForInADirectionOfTheSeed) {
  OpenedScene session = box_session();
  const Eigen::VectorXd at = initial_state(session, {});
  session.init.away = 0.03;
  session.init.away_turn = 15 * kDegree;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (session.seed = 1; session.seed <= 64; ++session.seed) {
    const Eigen::VectorXd away = initial_state(session, {});
    const Eigen::Vector3d moved = (away - at).head<3>();
    EXPECT_NEAR(moved.norm(), 0.03, 1e-12);
    EXPECT_NEAR(away.segment<4>(3).dot(at.segment<4>(3)), std::cos(7.5 * kDegree), 1e-12);
    EXPECT_EQ(initial_state(session, {}), away);
    mean += moved / 64;
  }
  EXPECT_LT(mean.norm(), 0.010) << "all directions";
}

TEST(InitialState, HasJointAnglesAsFarOffAsAskedForWithinTheirBounds) {
  OpenedScene session;
  session.scene =
      std::make_unique<Scene>(std::vector<std::pair<std::string, std::shared_ptr<const Model>>>{
          {"hand", std::make_shared<Model>(test::make_test_hand())}});
  const auto& parameters = session.scene->parameters();
  Eigen::VectorXd at = session.scene->rest_state();
  for (std::size_t i = 7; i < parameters.size(); ++i) {
    at[static_cast<Eigen::Index>(i)] = 0.5 * (parameters[i].lower + parameters[i].upper);
  }
  Frame frame;
  frame.truth = GroundTruth{at, {}};
  session.init.from = InitFrom::truth;
  constexpr double kDeviation = 5 * kDegree;
  session.init.away_angles = kDeviation;
  double squares = 0;
  int free = 0;
  for (session.seed = 1; session.seed <= 64; ++session.seed) {
    const Eigen::VectorXd away = initial_state(session, frame);
    EXPECT_EQ(initial_state(session, frame), away);
    EXPECT_EQ(away.head<7>(), at.head<7>());
    for (std::size_t i = 7; i < parameters.size(); ++i) {
      const auto d = static_cast<Eigen::Index>(i);
      EXPECT_LE(away[d], parameters[i].upper);
      EXPECT_GE(away[d], parameters[i].lower);
      if (parameters[i].upper - at[d] < 4 * kDeviation) continue;  // bounds cut there
      squares += (away[d] - at[d]) * (away[d] - at[d]);
      ++free;
    }
  }
  ASSERT_GT(free, 400);
  EXPECT_NEAR(std::sqrt(squares / free), kDeviation, 0.1 * kDeviation);
}

TEST(InitialState, IsAPoseFile) {
  const test::TemporaryDirectory folder;
  OpenedScene session = box_session();
  session.init.from = InitFrom::file;
  session.init.file = folder.path() / "pose.yaml";
  std::ofstream(session.init.file) << "box:\n  position_mm: [0, 0, 700]\n";
  EXPECT_NEAR(initial_state(session, {})[2], 0.700, 1e-12);
}

TEST(InitialState, IsARowOfAStateTable) {
  const test::TemporaryDirectory folder;
  OpenedScene session = box_session();
  session.init.from = InitFrom::file;
  session.init.file = folder.path() / "track.csv";
  session.init.frame = 4;
  const std::vector<StateRow> rows{{3, 0.1, session.scene->rest_state()},
                                   {4, 0.2, session.scene->rest_state()}};
  write_states(session.init.file, *session.scene, rows);
  EXPECT_EQ(initial_state(session, {}), rows[1].state);
  session.init.frame = 9;
  EXPECT_THAT(message_of(session, {}), HasSubstr("has no frame 9 to start from; it has 3 to 4"));
}

TEST(InitialState, IsNotToBeHadFromATableWithoutRows) {
  const test::TemporaryDirectory folder;
  OpenedScene session = box_session();
  session.init.from = InitFrom::file;
  session.init.file = folder.path() / "track.csv";
  write_states(session.init.file, *session.scene, {});
  EXPECT_THAT(message_of(session, {}), HasSubstr("has no rows; expected one to start from"));
}

}  // namespace
}  // namespace hypotrack
