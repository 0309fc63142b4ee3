// The synthetic source on a table of landmarks instead of keyframes.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/tables.hpp"
#include "hypotrack/plugin/params.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "test_models.hpp"
#include "test_paths.hpp"

namespace hypotrack::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

Scene hand_scene() { return Scene({{"hand", std::make_shared<Model>(make_test_hand())}}); }

/// A hand that closes while it moves and turns, in the frames 5 to 14.
std::vector<StateRow> motion(const Scene& scene) {
  std::vector<StateRow> rows;
  for (int i = 0; i < 10; ++i) {
    StateRow row{5 + i, 0, scene.rest_state()};
    row.state.head<3>() << 0.01 * i, 0.05, 0.45 + 0.004 * i;
    const Eigen::Quaterniond q(
        Eigen::AngleAxisd((170 + 2 * i) * kDegree, Eigen::Vector3d(1, 0.2, 0).normalized()));
    row.state.segment<4>(3) << q.w(), q.x(), q.y(), q.z();
    for (Eigen::Index k = 8; k < row.state.size(); k += 4)
      for (Eigen::Index j = 0; j < 3; ++j)
        row.state[std::min(k + j, row.state.size() - 1)] = 4 * i * kDegree;
    rows.push_back(row);
  }
  return rows;
}

struct JointFile {
  JointFile() : states(motion(scene)) {
    for (const StateRow& row : states)
      rows.push_back({row.frame, 0, 1e3 * scene.landmarks(row.state)});  // millimetres
  }
  std::unique_ptr<Source> source(const std::string& more = "") {
    write_landmarks(file, scene.landmark_names(), rows);
    return plugins.make<Source>(
        ConfigNode::parse("type: synthetic\n"
                          "cameras: {width: 160, height: 96, focal_px: 90}\n"
                          "background: {kind: color}\n"
                          "joint_file: {file: " +
                              file.string() + ", units: mm" + more + "}\n",
                          "scene.yaml"),
        &scene);
  }
  double error(const Frame& frame, std::size_t row) const {
    return (scene.landmarks(frame.truth->state) - scene.landmarks(states[row].state))
        .colwise()
        .norm()
        .mean();
  }
  TemporaryDirectory folder;
  std::filesystem::path file = folder.path() / "joints.csv";
  PluginLoader plugins;
  Scene scene = hand_scene();
  std::vector<StateRow> states;
  std::vector<LandmarkRow> rows;
};

TEST(JointFile, IsFollowedWithinAMillimetre) {
  JointFile joints;
  testing::internal::CaptureStderr();
  const auto source = joints.source();
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              AllOf(HasSubstr("'hand' fitted to 10 of 10 rows"), HasSubstr("mm on average"),
                    HasSubstr("times as large it would fit best")));
  EXPECT_EQ(source->frame_count(), 10);
  for (std::size_t i = 0; i < 10; ++i) {
    const std::optional<Frame> frame = source->next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->index, static_cast<int>(i));
    EXPECT_LT(joints.error(*frame, i), 1e-3) << i;
    EXPECT_NO_THROW(joints.scene.check(frame->truth->state, "fit"));
  }
  EXPECT_FALSE(source->next());
}

TEST(JointFile, GapsAreBridged) {
  JointFile joints;
  joints.rows[3].landmarks.setConstant(kUnknown);
  joints.rows[7].landmarks.rightCols(5).setConstant(kUnknown);  // known well enough
  joints.rows.erase(joints.rows.begin() + 5);
  testing::internal::CaptureStderr();
  const auto source = joints.source();
  EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("fitted to 8 of 9 rows"));
  EXPECT_EQ(source->frame_count(), 10);
  for (std::size_t i = 0; i < 10; ++i) {
    const std::optional<Frame> frame = source->next();
    ASSERT_TRUE(frame);
    EXPECT_LT(joints.error(*frame, i), i == 7 ? 3e-3 : 1.5e-3) << i;
  }
}

TEST(JointFile, IsSmoothedIfAsked) {
  JointFile joints;
  for (std::size_t i = 0; i < joints.rows.size(); ++i)
    joints.rows[i].landmarks.row(1).array() += i % 2 == 0 ? 4.0 : -4.0;
  joints.rows[6].landmarks.col(20).setConstant(kUnknown);
  const auto jitter = [&](const std::string& more) {
    testing::internal::CaptureStderr();
    const auto source = joints.source(more);
    testing::internal::GetCapturedStderr();
    double sum = 0;
    for (std::size_t i = 0; i < 10; ++i) {
      const Frame frame = *source->next();
      sum += std::abs(frame.truth->state[1] - joints.states[i].state[1]) / 10;
    }
    return sum;
  };
  EXPECT_GT(jitter(""), 3e-3);
  EXPECT_LT(jitter(", smooth_frames: 1.5"), 1.2e-3);
}

TEST(JointFile, GivesAPartOfItself) {
  JointFile joints;
  testing::internal::CaptureStderr();
  const auto source = joints.source(", first: 7, count: 4");
  testing::internal::GetCapturedStderr();
  EXPECT_EQ(source->frame_count(), 4);
  EXPECT_LT(joints.error(*source->next(), 2), 1e-3);
}

TEST(JointFile, ExplainsWhatIsWrong) {
  JointFile joints;
  EXPECT_THAT(message_of<DataError>([&] { joints.source(", first: 90"); }),
              AllOf(HasSubstr("joints.csv"), HasSubstr("no row of frame 90 or later")));
  for (LandmarkRow& row : joints.rows) row.landmarks.rightCols(15).setConstant(kUnknown);
  EXPECT_THAT(message_of<DataError>([&] { joints.source(); }),
              AllOf(HasSubstr("joints.csv"), HasSubstr("half of the landmarks of 'hand'")));
  const auto make = [&](const std::string& yaml) {
    return message_of<ConfigError>([&] {
      joints.plugins.make<Source>(ConfigNode::parse("type: synthetic\n" + yaml, "scene.yaml"),
                                  &joints.scene);
    });
  };
  EXPECT_THAT(make(""),
              AllOf(HasSubstr("scene.yaml"), HasSubstr("one of `keyframes`, `joint_file")));
  EXPECT_THAT(make("joint_file: {file: a.csv}\nkeyframes: [{time: 0}]\n"),
              HasSubstr("one of `keyframes`, `joint_file"));
}

}  // namespace
}  // namespace hypotrack::test
