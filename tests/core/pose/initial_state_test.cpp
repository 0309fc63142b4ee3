#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <memory>
#include <random>

#include "hypotrack/api/error.hpp"
#include "hypotrack/api/pose.hpp"
#include "hypotrack/api/tables.hpp"
#include "hypotrack/plugin/params.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "session/opened_scene.hpp"
#include "test_models.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// Gives a session the starter that `init.from` names by this map.
void set_start(OpenedScene& session, const std::string& from) {
  session.init.from = ConfigNode::parse(from, "test");
  session.starter = PluginLoader().make<Starter>(session.init.from, session.scene.get());
}

OpenedScene session_of(const std::string& name, const ModelData& model) {
  OpenedScene session;
  session.scene =
      std::make_unique<Scene>(std::vector<std::pair<std::string, std::shared_ptr<const Model>>>{
          {name, std::make_shared<Model>(model)}});
  set_start(session, "type: rest");
  return session;
}

OpenedScene box_session() { return session_of("box", test::make_test_box()); }
OpenedScene hand_session() { return session_of("hand", test::make_test_hand()); }

std::string quoted(const std::filesystem::path& file) { return '"' + file.string() + '"'; }

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

TEST(InitialState, HasJointsOfAllKindsAsThePoseSaysAndWritesThem) {
  OpenedScene session = session_of("cabinet", test::make_test_cabinet());
  session.init.pose = ConfigNode::parse(
      "{cabinet: {angles_deg: {door: 30, knob: -400}, lengths_mm: {drawer: 12.5}}}", "test");
  const Eigen::VectorXd state = initial_state(session, {});
  EXPECT_NEAR(state[7], 0.0125, 1e-12);
  EXPECT_NEAR(state[8], 30 * kDegree, 1e-12);
  EXPECT_NEAR(state[9], -400 * kDegree, 1e-12);
  const std::string yaml = pose_yaml(*session.scene, state, {true});
  EXPECT_THAT(yaml, HasSubstr("  angles_deg:\n    door: 30\n    knob: -400\n  lengths_mm:\n"
                              "    drawer: 12.5\n"));
  EXPECT_TRUE(
      read_pose(ConfigNode::parse(yaml, "test"), *session.scene, session.scene->rest_state())
          .isApprox(state, 1e-6));
  const auto message = [&](const std::string& pose) {
    session.init.pose = ConfigNode::parse("{cabinet: {" + pose + "}}", "test");
    return message_of(session, {});
  };
  EXPECT_THAT(message("lengths_mm: {drawer: 81}"), HasSubstr("80"));
  EXPECT_THAT(message("lengths_mm: {door: 1}"),
              HasSubstr("lengths_mm.door: unknown key. Allowed: drawer"));
  EXPECT_THAT(message("angles_deg: {drawer: 1}"),
              HasSubstr("angles_deg.drawer: unknown key. Allowed: door, knob"));
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
  set_start(session, "type: truth");
  Frame frame;
  EXPECT_THAT(message_of(session, frame), HasSubstr("the source knows no true state"));
  frame.truth = GroundTruth{{}, Eigen::Matrix3Xd::Zero(3, 3)};
  EXPECT_THAT(message_of(session, frame),
              testing::AllOf(HasSubstr("only the true landmarks"),
                             HasSubstr("{from: {type: landmarks, file: FILE}}")));
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
  OpenedScene session = hand_session();
  const auto& parameters = session.scene->parameters();
  Eigen::VectorXd at = session.scene->rest_state();
  for (std::size_t i = 7; i < parameters.size(); ++i) {
    at[static_cast<Eigen::Index>(i)] = 0.5 * (parameters[i].lower + parameters[i].upper);
  }
  Frame frame;
  frame.truth = GroundTruth{at, {}};
  set_start(session, "type: truth");
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
  const auto file = folder.path() / "pose.yaml";
  std::ofstream(file) << "box:\n  position_mm: [0, 0, 700]\n";
  set_start(session, "{type: file, file: " + quoted(file) + "}");
  EXPECT_NEAR(initial_state(session, {})[2], 0.700, 1e-12);
}

TEST(InitialState, IsTheRowOfThatFrameInAStateTable) {
  const test::TemporaryDirectory folder;
  OpenedScene session = box_session();
  const auto file = folder.path() / "track.csv";
  Eigen::VectorXd moved = session.scene->rest_state();
  moved[0] += 0.125;
  const std::vector<StateRow> rows{{3, 0.1, session.scene->rest_state()}, {5, 0.2, moved}};
  write_states(file, *session.scene, rows);
  for (const StateRow& row : rows) {
    set_start(session,
              "{type: file, frame: " + std::to_string(row.frame) + ", file: " + quoted(file) + "}");
    EXPECT_EQ(initial_state(session, {}), row.state);
  }
  for (const char* missing : {"0", "4", "9"}) {  // 4 is between two rows
    set_start(session,
              std::string("{type: file, frame: ") + missing + ", file: " + quoted(file) + "}");
    EXPECT_THAT(message_of(session, {}), HasSubstr(std::string("has no frame ") + missing +
                                                   " to start from; it has 3 to 5"));
  }
}

TEST(InitialState, IsNotToBeHadFromATableWithoutRows) {
  const test::TemporaryDirectory folder;
  OpenedScene session = box_session();
  const auto file = folder.path() / "track.csv";
  write_states(file, *session.scene, {});
  set_start(session, "{type: file, file: " + quoted(file) + "}");
  EXPECT_THAT(message_of(session, {}), HasSubstr("has no rows; expected one to start from"));
}

TEST(InitialState, TakesAFrameOnlyWhereTheStartNeedsOne) {
  OpenedScene session = box_session();
  EXPECT_EQ(start_state(session, nullptr), session.scene->rest_state());
  set_start(session, "type: truth");
  EXPECT_EQ(start_state(session, nullptr), std::nullopt);
}

TEST(InitialState, IsInViewOfBothCamerasWhereModelsAreLookedFor) {
  OpenedScene session = hand_session();
  session.starter.reset();
  Camera camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = camera.fy = 600;
  camera.cx = 319.5;
  camera.cy = 239.5;
  Camera other = camera;
  other.camera_from_world.translation().x() = -0.12;
  // Cameras side by side, and cameras half a metre apart that look at one point.
  Camera turned = camera;
  turned.camera_from_world.linear() =
      Eigen::AngleAxisd(0.75, Eigen::Vector3d::UnitY()).toRotationMatrix();
  turned.camera_from_world.translation() =
      -(turned.camera_from_world.linear() * Eigen::Vector3d(0.5, 0, 0));
  for (const Camera& second : {other, turned}) {
    session.parts.cameras = {camera, second};
    const Eigen::Matrix3Xd landmarks =
        session.scene->landmarks(start_state(session, nullptr).value());
    for (const Camera& one : session.parts.cameras) {
      const Eigen::Vector2d middle = project(one, landmarks.rowwise().mean());
      EXPECT_NEAR(middle.x(), one.cx, 100);
      EXPECT_NEAR(middle.y(), one.cy, 100);
    }
  }
}

/// A hand in some pose, and a table of its landmarks in frame 2.
class LandmarkStarter : public ::testing::Test {
 protected:
  LandmarkStarter() : file_(folder_.path() / "labels.csv") {
    const Scene& scene = *session_.scene;
    std::mt19937_64 random(4);
    Eigen::VectorXd state = test::random_state(scene, random);
    state.tail(20) = 0.5 * (state.tail(20) + scene.rest_state().tail(20));
    truth_ = scene.landmarks(state);
  }

  void write(double scale = 1) {
    const std::vector<LandmarkRow> rows{{1, 0, 2 * truth_}, {2, 0, scale * truth_}};
    write_landmarks(file_, session_.scene->landmark_names(), rows);
  }
  void set(const std::string& more) {
    set_start(session_, "{type: landmarks, file: " + quoted(file_) + ", " + more + "}");
  }
  double mean_error() {
    return (session_.scene->landmarks(initial_state(session_, {})) - truth_)
        .colwise()
        .norm()
        .mean();
  }

  const test::TemporaryDirectory folder_;
  std::filesystem::path file_;
  OpenedScene session_ = hand_session();
  Eigen::Matrix3Xd truth_;
};

TEST_F(LandmarkStarter, FitsTheModelToTheLandmarks) {
  write();
  set("frame: 2");
  EXPECT_LT(mean_error(), 1e-3);
  EXPECT_TRUE(start_state(session_, nullptr).has_value()) << "it needs no frame";
}

TEST_F(LandmarkStarter, FitsToSomeLandmarksInOtherUnits) {
  const Eigen::Matrix3Xd all = truth_;
  truth_.rightCols(4).setConstant(std::nan(""));
  write(1000);
  truth_ = all;
  set("frame: 2, units: mm");
  EXPECT_LT(mean_error(), 10e-3);
}

TEST_F(LandmarkStarter, RefusesLandmarksOfAnotherSize) {
  write();
  set("frame: 2, units: mm");
  EXPECT_THAT(message_of(session_, {}),
              AllOf(HasSubstr("labels.csv: frame 2 does not fit the model 'hand'"),
                    HasSubstr("units (now mm)")));
  set("frame: 2, units: cm");
  EXPECT_THAT(message_of(session_, {}), HasSubstr("does not fit the model 'hand'"));
}

TEST_F(LandmarkStarter, SaysWhatItDoesNotFind) {
  write();
  set("frame: 7");
  EXPECT_THAT(message_of(session_, {}), HasSubstr("frame 7 is not there: the file has 1 to 2"));
  truth_.rightCols(20).setConstant(std::nan(""));
  write();
  set("frame: 2");
  EXPECT_THAT(message_of(session_, {}),
              HasSubstr("frame 2 cannot place the model 'hand': 1 known landmarks"));
  truth_.setConstant(std::nan(""));
  write();
  EXPECT_THAT(message_of(session_, {}), HasSubstr("frame 2 knows no landmark of the scene"));
}

TEST_F(LandmarkStarter, RefusesLandmarksThatFixNoPose) {
  set("frame: 2");
  truth_.col(3).x() = 1e5;
  write();
  EXPECT_THAT(message_of(session_, {}), HasSubstr("has a landmark of 'hand' 1e+05 m away"));
  for (Eigen::Index i = 0; i < truth_.cols(); ++i)
    truth_.col(i) = Eigen::Vector3d(0.01, 0.02, 0.5 + 0.01 * static_cast<double>(i));
  write();
  EXPECT_THAT(message_of(session_, {}), HasSubstr("only landmarks of 'hand' on a line"));
}

TEST_F(LandmarkStarter, LeavesAModelWithoutLandmarksAtRest) {
  session_.scene =
      std::make_unique<Scene>(std::vector<std::pair<std::string, std::shared_ptr<const Model>>>{
          {"box", std::make_shared<Model>(test::make_test_box())},
          {"hand", std::make_shared<Model>(test::make_test_hand())}});
  const Eigen::Index box = session_.scene->landmarks(session_.scene->rest_state()).cols() - 21;
  Eigen::Matrix3Xd both(3, box + 21);
  both << Eigen::Matrix3Xd::Constant(3, box, std::nan("")), truth_;
  truth_ = both;
  write();
  set("frame: 2");
  const Eigen::VectorXd state = initial_state(session_, {});
  EXPECT_EQ(state.head<7>(), session_.scene->rest_state().head<7>());
  EXPECT_LT((session_.scene->landmarks(state) - truth_).rightCols(21).colwise().norm().mean(),
            1e-3);
}

}  // namespace
}  // namespace hypotrack
