// Motions that the synthetic source draws from a seed.

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <set>
#include <string>
#include <vector>

#include "hypotrack/api/camera.hpp"
#include "hypotrack/plugin/kinematics.hpp"
#include "synthetic_fixture.hpp"

namespace hypotrack::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

const std::string kGestures =
    "gestures:\n  open: {\"*_flexion_?\": 5}\n  fist: {\"*_flexion_*\": 50}\n"
    "  point: {\"*_flexion_*\": 50, \"index_flexion_*\": 0}\n";
const std::string kGestured = std::string(kCameras) + kQuiet + kPlain + kGestures;

std::string random_motion(int seed, const std::string& more) {
  return kGestured + "random: {seed: " + std::to_string(seed) + ", " + more + "}\n";
}

/// Whether a frame's landmarks are all in both pictures.
bool is_in_view(const Loaded& loaded, const Frame& frame) {
  const Eigen::Matrix3Xd landmarks = loaded.scene.landmarks(frame.truth->state);
  for (const Camera& camera : loaded.source->cameras())
    for (Eigen::Index i = 0; i < landmarks.cols(); ++i) {
      const Eigen::Vector2d p = project(camera, landmarks.col(i));
      if (!(p.x() > 0 && p.y() > 0 && p.x() < camera.width - 1 && p.y() < camera.height - 1))
        return false;
    }
  return true;
}

Eigen::Vector3d origin(const Loaded& loaded, const Frame& frame, std::size_t model) {
  return frame.truth->state.segment<3>(loaded.scene.items()[model].offset);
}

TEST(RandomMotion, StaysInViewAndWithinItsSpeed) {
  std::set<double> bends;
  for (const int seed : {1, 2, 3}) {
    Loaded loaded(random_motion(seed, "frames: 50"));
    const std::vector<Frame> frames = loaded.frames();
    ASSERT_EQ(frames.size(), 50U);
    for (std::size_t f = 0; f < frames.size(); ++f) {
      EXPECT_TRUE(is_in_view(loaded, frames[f])) << f;
      EXPECT_NO_THROW(loaded.scene.check(frames[f].truth->state, "truth"));
      EXPECT_GE((origin(loaded, frames[f], 0) - origin(loaded, frames[f], 1)).norm(), 0.12);
      bends.insert(frames[f].truth->state[parameter(loaded.scene, "hand.index_flexion_2")]);
      if (f == 0) continue;
      // A smooth step is up to 1.5 times as fast as its mean, one between two others up to 3 times.
      EXPECT_LT((origin(loaded, frames[f], 0) - origin(loaded, frames[f - 1], 0)).norm(),
                3 * 0.3 / 30);
    }
  }
  EXPECT_GT(*bends.rbegin() - *bends.begin(), 10 * kDegree) << "gestures change";
}

TEST(RandomMotion, IsAFunctionOfItsSeed) {
  const std::string absence = "frames: 20, absence: {after: 5, frames: [1, 8]}";
  const std::vector<Frame> a = load(random_motion(7, absence)).frames();
  const std::vector<Frame> b = load(random_motion(7, absence)).frames();
  const std::vector<Frame> c = load(random_motion(8, absence)).frames();
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t f = 0; f < a.size(); ++f) EXPECT_EQ(a[f].truth->state, b[f].truth->state);
  EXPECT_NE(a[0].truth->state, c[0].truth->state);
}

TEST(RandomMotion, ModelsVanishAndAreBackElsewhere) {
  double farthest = 0;
  std::set<int> lengths;
  for (const int seed : {1, 2, 3, 4}) {
    Loaded loaded(random_motion(seed, "frames: 18, absence: {after: 6, frames: [2, 9]}"));
    const std::vector<Frame> frames = loaded.frames();
    int seen = 0, in_a_row = 0, absent = 0;
    Eigen::Vector3d last = Eigen::Vector3d::Zero();
    for (const Frame& frame : frames) {
      if (!frame.truth->absent.empty()) {
        EXPECT_EQ(frame.truth->absent, (std::vector<bool>{true, true}));
        EXPECT_EQ(cv::countNonZero(frame.views[0].mask), 0);
        EXPECT_TRUE(in_a_row == 6 || absent > 0);
        in_a_row = 0;
        ++absent;
        continue;
      }
      EXPECT_TRUE(is_in_view(loaded, frame));
      if (absent > 0) {
        lengths.insert(absent);
        farthest = std::max(farthest, (origin(loaded, frame, 0) - last).norm());
      }
      absent = 0;
      last = origin(loaded, frame, 0);
      ++in_a_row;
      ++seen;
    }
    EXPECT_EQ(seen, 18);
    EXPECT_EQ(in_a_row, 6) << "it ends in view";
  }
  EXPECT_GT(farthest, 0.08);
  EXPECT_GE(lengths.size(), 3U);
  EXPECT_GE(*lengths.begin(), 2);
  EXPECT_LE(*lengths.rbegin(), 9);
}

TEST(RandomMotion, AHeldModelKeepsItsPlaceAtTheHolder) {
  Loaded loaded(random_motion(
      2,
      "frames: 12, absence: {after: 6, frames: [2, 2]}, hold: {box: hand}, pose: {hand: "
      "{position_mm: [0, 0, 500], rotation_deg: [180, 0, 0]}, box: {position_mm: [0, -80, 470]}}"));
  const auto grip = [&](const Frame& frame) {
    const auto place = [&](std::size_t m) {
      return world_from_model(loaded.scene.part(loaded.scene.items()[m], frame.truth->state));
    };
    return place(0).inverse() * place(1);
  };
  const Eigen::Vector3d expected(0, 0.08, 0.03);
  for (const Frame& frame : loaded.frames())
    EXPECT_LT((grip(frame).translation() - expected).norm(), 1e-9) << frame.index;
}

TEST(RandomMotion, AFacingHandShowsPalmOrBackAndNoFingersDownwards) {
  int palms = 0, backs = 0, away = 0;
  for (int seed = 0; seed < 12; ++seed) {
    for (const std::string rotation : {"facing, tilt_deg: 30", "any"}) {
      Loaded loaded(random_motion(seed, "frames: 1, gesture_s: 1000, rotation: " + rotation));
      const Frame frame = *loaded.source->next();
      const Eigen::Matrix3d r =
          world_from_model(loaded.scene.part(loaded.scene.items()[0], frame.truth->state)).linear();
      const double facing = -r(2, 2);
      if (rotation == "any") {
        away += std::abs(facing) < 0.8;
        continue;
      }
      // Between the drawn postures it may turn over.
      if (std::abs(facing) > 0.8) (facing > 0 ? palms : backs) += 1;
    }
  }
  EXPECT_GT(palms, 0);
  EXPECT_GT(backs, 0);
  EXPECT_GT(away, 4);
}

TEST(RandomMotion, TakesThePlaceOfKeyframesThatAreNull) {
  Loaded loaded(random_motion(1, "frames: 3") + "keyframes: null\n");
  EXPECT_EQ(loaded.source->frame_count(), 3);
}

TEST(RandomMotion, ExplainsWhatIsWrongWithIt) {
  const auto message = [](const std::string& random) {
    return message_of(kGestures + "random:\n  {" + random + "}\n");
  };
  EXPECT_THAT(message_of(kMotion + std::string("random: {seed: 1}\n")),
              AllOf(HasSubstr("scene.yaml:"), HasSubstr("one of `keyframes`")));
  EXPECT_THAT(message("gestures: [open, wave]"),
              AllOf(HasSubstr("scene.yaml:8:"), HasSubstr("no gesture is called 'wave'")));
  EXPECT_THAT(message("gestures: []"), HasSubstr("a list of names of gestures"));
  EXPECT_THAT(message("lowest_mm: [0, 0, 900]"), HasSubstr("exceed"));
  EXPECT_THAT(message("absence: {frames: [5, 2]}"),
              AllOf(HasSubstr("scene.yaml:8:"), HasSubstr("an absence of 5 to 2 frames")));
  EXPECT_THAT(message("lowest_mm: [0, 0, 100], highest_mm: [1, 1, 101]"),
              AllOf(HasSubstr("scene.yaml:8:"), HasSubstr("found no motion")));
  EXPECT_THAT(message("hold: {box: foot}"), HasSubstr("'foot' is no model of this scene"));
  EXPECT_THAT(message("hold: {box: hand, hand: box}"), HasSubstr("must not be held itself"));
  EXPECT_THAT(message("sped: 1"), HasSubstr("sped"));
}

TEST(RandomMotion, IsNotBlurredOverAnAbsence) {
  const std::string rest = std::string(kCameras) + kPlain + kGestures +
                           "random: {seed: 3, frames: 6, absence: {after: 3, frames: [1, 1]}}\n";
  const std::vector<Frame> sharp = load(rest + "sensor: {noise_sigma: 0}\n").frames();
  const std::vector<Frame> blurred =
      load(rest + "sensor: {noise_sigma: 0, exposure_s: 0.03}\n").frames();
  ASSERT_EQ(sharp.size(), 7U);
  for (const std::size_t f : {2U, 4U}) {  // the last before it and the first after it
    const View& view = sharp[f].views[0];
    cv::Mat near, difference;
    cv::dilate(view.mask, near, cv::Mat(), {-1, -1}, 20);
    cv::absdiff(view.color, blurred[f].views[0].color, difference);
    EXPECT_EQ(cv::mean(difference, near == 0), cv::Scalar::all(0)) << f;
    EXPECT_GT(cv::mean(difference, near)[1], 0) << f;
  }
}

}  // namespace
}  // namespace hypotrack::test
