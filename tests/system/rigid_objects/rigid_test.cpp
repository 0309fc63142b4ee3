// The trackers for rigid objects on a rendered box that moves, and that a board passes.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "output/metrics/landmark_errors.hpp"
#include "session/opened_scene.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

struct BoxFrame {
  Status status;
  double error_mm;
};

/// A second camera that is turned against its calibration.
struct WrongTurn {
  double angle = 0;  ///< radians
  int laps = 1;      ///< the recording is played to and fro
  std::vector<std::string> overrides = {};
  std::vector<std::string> notes = {};  ///< those of the tracker are added
};

/// Tracks a plain box, of which a board without a model hides what `board` says.
std::vector<BoxFrame> track_box(const std::string& tracker, const std::string& cameras,
                                const std::string& board, WrongTurn* wrong = nullptr) {
  const test::TemporaryDirectory folder;
  const auto file = folder.path() / "scene.yaml";
  std::ofstream(file) << fmt::format(
      R"(models: [{{name: box, type: rigid_box, size_mm: [70, 50, 120], pattern: 3}}]
source:
  type: synthetic
  cameras: {{width: 320, height: 240, focal_px: 300, {}}}
  light: {{ambient: 0.7, diffuse: 0.4}}
  sensor: {{noise_sigma: 2}}
  background: {{kind: procedural, distance_mm: 1500}}
  {}
  keyframes:
    - {{frame: 0, pose: {{box: {{position_mm: [0, 0, 500], rotation_deg: [30, 25, 10]}}}}}}
    - {{frame: 12, pose: {{box: {{position_mm: [60, 15, 540], rotation_deg: [50, 5, 20]}}}}}}
    - {{frame: 24, pose: {{box: {{position_mm: [10, -20, 480], rotation_deg: [35, 30, 0]}}}}}}
tracker: "@trackers/{}"
init: {{from: truth}}
evaluate: {{backend: cpu}}
)",
      cameras, board, tracker);
  const std::string term = tracker == "rigid" ? "objective.0" : "objective";
  PluginLoader plugins;
  std::vector<std::string> overrides = {term + ".subdivisions=2",
                                        term + ".cache=" + folder.path().string()};
  if (wrong) overrides.insert(overrides.end(), wrong->overrides.begin(), wrong->overrides.end());
  OpenedScene session = open_scene(file, overrides, plugins);
  const Scene& scene = *session.scene;
  const LandmarkLayout layout = landmark_layout(scene.landmark_names());
  if (wrong) {
    Eigen::Isometry3d& second = session.parts.cameras.at(1).camera_from_world;
    second = Eigen::Isometry3d(Eigen::AngleAxisd(-wrong->angle, Eigen::Vector3d::UnitY())) * second;
  }
  std::optional<SceneTracker> found;
  std::vector<BoxFrame> out;
  std::vector<Frame> frames;
  const int last = wrong ? 24 * wrong->laps : 24;
  for (int i = 0; i <= last; ++i) {
    if (i <= 24) frames.push_back(session.source->next().value());
    const int lap = i / 24, at = i % 24;
    Frame frame = frames[static_cast<std::size_t>(lap % 2 == 0 ? at : 24 - at)];
    frame.index = i;
    frame.time = i / 30.0;
    if (!found)
      found.emplace(scene, std::move(session.parts), initial_state(session, frame), session.seed);
    const Solution s = found->track(frame);
    const double error =
        frame_error(layout, scene.landmarks(s.state), scene.landmarks(frame.truth->state)).mean;
    out.push_back({s.status, 1000 * error});
  }
  if (wrong) wrong->notes = found->take_rig_notes();
  return out;
}

double mean_error(const std::vector<BoxFrame>& frames) {
  double sum = 0;
  for (const BoxFrame& frame : frames) sum += frame.error_mm;
  return sum / static_cast<double>(frames.size());
}

double worst_error(const std::vector<BoxFrame>& frames) {
  return std::ranges::max(frames, {}, &BoxFrame::error_mm).error_mm;
}

const std::string kPair = "baseline_mm: 60", kOne = "count: 1";
const std::string kNothing;
const std::string kBoard =
    "cards: [{frames: [8, 16], at_mm: [10, 0, 350], size_mm: [45, 200], color: [60, 160, 70]}]";

TEST(RigidObjects, AreTrackedWithTwoCameras) {
  const std::vector<BoxFrame> frames = track_box("rigid", kPair, kNothing);
  for (const BoxFrame& frame : frames) EXPECT_EQ(frame.status, Status::tracked);
  EXPECT_LT(mean_error(frames), 1);
  EXPECT_LT(worst_error(frames), 3);
}

TEST(RigidObjects, AreTrackedWithOneCamera) {
  const std::vector<BoxFrame> frames = track_box("rigid_one_camera", kOne, kNothing);
  for (const BoxFrame& frame : frames) EXPECT_LE(frame.status, Status::uncertain);
  EXPECT_LT(mean_error(frames), 3);
  EXPECT_LT(worst_error(frames), 8);
}

TEST(RigidObjects, TellByTheirOutlinesThatACameraIsTurned) {
  for (const double angle : {0.0, 0.01, -0.01}) {
    WrongTurn wrong{.angle = angle, .laps = 2};
    track_box("rigid", kPair, kNothing, &wrong);
    if (angle == 0)
      EXPECT_THAT(wrong.notes, IsEmpty());
    else
      EXPECT_THAT(wrong.notes, ElementsAre(HasSubstr(angle > 0 ? "inwards" : "outwards"))) << angle;
  }
}

TEST(RigidObjects, AreTwiceAsExactOnceATurnOfACameraIsUndone) {
  WrongTurn wrong{.angle = 0.01, .laps = 5, .overrides = {"status.correct_turn=true"}};
  const std::vector<BoxFrame> frames = track_box("rigid", kPair, kNothing, &wrong);
  const double before = mean_error({frames.begin(), frames.begin() + 20});
  EXPECT_LT(mean_error({frames.end() - 20, frames.end()}), before / 2);
  EXPECT_THAT(wrong.notes, ElementsAre(HasSubstr("pictures are moved to fit")));
}

TEST(RigidObjects, AreNeitherLostNorTurnedBehindABoard) {
  const std::vector<BoxFrame> frames = track_box("rigid", kPair, kBoard);
  for (const BoxFrame& frame : frames) EXPECT_LE(frame.status, Status::uncertain);
  EXPECT_EQ(frames.back().status, Status::tracked);
  EXPECT_LT(frames.back().error_mm, 2);
  EXPECT_LT(worst_error(frames), 8);
}

}  // namespace
}  // namespace hypotrack
