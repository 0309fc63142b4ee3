#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <opencv2/core.hpp>
#include <string>

#include "hypotrack/api/media.hpp"
#include "hypotrack/api/renderer.hpp"
#include "hypotrack/plugin/kinematics.hpp"
#include "synthetic_fixture.hpp"
#include "test_paths.hpp"

namespace hypotrack::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(Synthetic, YieldsTheFramesUpToTheLastKeyframeWithTruthAndMask) {
  Loaded loaded(std::string(kCameras) + kQuiet + kPlain + kMotion);
  EXPECT_EQ(loaded.source->frame_count(), 11);
  EXPECT_EQ(loaded.source->frame_rate(), 30);
  ASSERT_EQ(loaded.source->cameras().size(), 2U);
  EXPECT_NEAR(loaded.source->cameras()[1].camera_from_world.translation().x(), -0.12, 1e-12);
  const std::vector<Frame> frames = loaded.frames();
  ASSERT_EQ(frames.size(), 11U);
  Renderer renderer(loaded.scene);
  for (std::size_t i = 0; i < frames.size(); i += 5) {
    const Frame& frame = frames[i];
    EXPECT_EQ(frame.index, static_cast<int>(i));
    EXPECT_NEAR(frame.time, static_cast<double>(i) / 30, 1e-12);
    EXPECT_NO_THROW(loaded.scene.check(frame.truth->state, "truth"));
    for (std::size_t v = 0; v < 2; ++v) {
      const RenderedView expected =
          renderer.render(frame.truth->state, loaded.source->cameras()[v], {});
      EXPECT_GT(cv::countNonZero(frame.views[v].mask), 1000);
      EXPECT_TRUE(same(frame.views[v].mask, expected.label > 0));
      EXPECT_EQ(frame.views[v].color.at<cv::Vec3b>(1, 1), cv::Vec3b(30, 20, 10));
    }
  }
}

TEST(Synthetic, PassesThroughPosesAndGestures) {
  Loaded loaded(std::string(kCameras) + kQuiet + kPlain + kMotion);
  const std::vector<Frame> frames = loaded.frames();
  const auto value = [&](std::size_t frame, const std::string& name) {
    return frames[frame].truth->state[parameter(loaded.scene, name)];
  };
  EXPECT_NEAR(value(0, "hand.position_x"), -0.020, 1e-12);
  EXPECT_NEAR(value(10, "hand.position_z"), 0.450, 1e-12);
  EXPECT_NEAR(value(5, "hand.index_flexion_2"), 50 * kDegree, 1e-12);
  EXPECT_NEAR(value(5, "hand.thumb_abduction"), 10 * kDegree, 1e-12);
  EXPECT_NEAR(value(5, "hand.ring_abduction"), 0, 1e-12) << "a gesture rests what it does not name";
  EXPECT_NEAR(value(10, "hand.index_flexion_1"), 15 * kDegree, 1e-12);
  EXPECT_NEAR(value(10, "hand.index_flexion_2"), 50 * kDegree, 1e-12) << "holds the last key";
  EXPECT_GT(value(5, "hand.position_x"), -0.019) << "a key that names no position does not stop it";
  EXPECT_LT(value(5, "hand.position_x"), 0.029);
  EXPECT_EQ(value(10, "box.position_x"), 0.1);
}

TEST(Synthetic, RepeatsItselfToTheByte) {
  const std::string yaml = std::string(kCameras) + kMotion + "frames: 2\n";
  const std::vector<Frame> a = load(yaml).frames(), b = load(yaml).frames();
  const std::vector<Frame> c = load(yaml + "sensor: {seed: 9}\n").frames();
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t v = 0; v < 2; ++v) {
      EXPECT_TRUE(same(a[i].views[v].color, b[i].views[v].color));
      EXPECT_FALSE(same(a[i].views[v].color, c[i].views[v].color)) << "another seed, other noise";
    }
  }
}

TEST(Synthetic, AddsNoiseOfTheGivenStrengthThatDiffersEverywhere) {
  const std::string yaml = std::string(kCameras) + kMotion +
                           "background: {kind: color, color: [100, 100, 100]}\n"
                           "sensor: {noise_sigma: 4}\nframes: 2\n";
  const std::vector<Frame> frames = load(yaml).frames();
  const cv::Rect corner(0, 0, 60, 200);  // background only
  cv::Scalar mean, deviation;
  cv::meanStdDev(frames[0].views[0].color(corner), mean, deviation);
  EXPECT_NEAR(mean[0], 100, 0.3);
  EXPECT_NEAR(deviation[0], 4, 0.3);
  for (const auto& [frame, view] : {std::pair(0, 1), std::pair(1, 0)}) {
    cv::Mat difference =
        frames[0].views[0].color(corner) !=
        frames[static_cast<std::size_t>(frame)].views[static_cast<std::size_t>(view)].color(corner);
    EXPECT_GT(cv::mean(difference)[0], 200) << frame << ' ' << view;
  }
}

TEST(Synthetic, ShowsTheWallWhereItsDistanceSaysInBothViews) {
  // f b / z = 175 * 0.12 / 1.4 = 15 px.
  const std::string yaml =
      std::string(kCameras) + kQuiet + kMotion +
      "background: {kind: procedural, distance_mm: 1400, clutter: 0}\nframes: 1\n";
  const std::vector<Frame> frames = load(yaml).frames();
  const cv::Mat left = frames[0].views[0].color(cv::Rect(15, 0, 60, 200)).clone();
  const cv::Mat right = frames[0].views[1].color(cv::Rect(0, 0, 60, 200)).clone();
  cv::Scalar mean, deviation;
  cv::meanStdDev(left, mean, deviation);
  EXPECT_GT(deviation[1], 8) << "the wall has a pattern";
  const auto difference = [&](const cv::Mat& a, const cv::Mat& b) {
    return cv::norm(a, b, cv::NORM_L1) / static_cast<double>(3 * a.total());
  };
  EXPECT_LT(difference(left, right), 0.5);
  EXPECT_GT(difference(left.colRange(1, 60), right.colRange(0, 59)), 2) << "one pixel beside it";
}

TEST(Synthetic, PutsAPictureUprightOnTheWall) {
  const TemporaryDirectory folder;
  cv::Mat picture(100, 160, CV_8UC3, cv::Scalar(0, 0, 200));
  picture.rowRange(50, 100).setTo(cv::Scalar(0, 200, 0));
  picture.colRange(0, 80).setTo(cv::Scalar(200, 0, 0));
  write_image((folder.path() / "wall.png").string(), picture);
  const std::string yaml =
      std::string(kCameras) + kQuiet + kMotion + "frames: 1\n" +
      "background: {kind: image, distance_mm: 1e5, file: " + (folder.path() / "wall.png").string() +
      "}\n";
  const cv::Mat left = load(yaml).frames()[0].views[0].color;
  EXPECT_EQ(left.at<cv::Vec3b>(10, 10), cv::Vec3b(200, 0, 0));
  EXPECT_EQ(left.at<cv::Vec3b>(10, 310), cv::Vec3b(0, 0, 200));
  EXPECT_EQ(left.at<cv::Vec3b>(190, 310), cv::Vec3b(0, 200, 0));
}

TEST(Synthetic, ClipsNoiseAtBlackAndWhite) {
  for (const int level : {2, 253}) {
    const std::string yaml = fmt::format(
        "{}{}background: {{kind: color, color: [{}, 128, 128]}}\nsensor: {{noise_sigma: 20}}\n"
        "frames: 1\n",
        kCameras, kMotion, level);
    cv::Mat red;
    cv::extractChannel(load(yaml).frames()[0].views[0].color, red, 2);
    const cv::Mat corner = red(cv::Rect(0, 0, 60, 200));  // background only
    const cv::Mat wrapped = level < 128 ? corner > 128 : corner < 128;
    EXPECT_EQ(cv::countNonZero(wrapped), 0) << level;
    const int end = level < 128 ? 0 : 255;
    EXPECT_GT(cv::countNonZero(corner == end), 4000) << level;
  }
}

TEST(Synthetic, ChangesTheColoursOfOneCamera) {
  const std::string yaml = std::string(kCameras) + kPlain + kMotion +
                           "sensor: {noise_sigma: 0, gain: [1, 1.5], offset: [0, 4]}\nframes: 1\n";
  const Frame frame = load(yaml).frames()[0];
  EXPECT_EQ(frame.views[0].color.at<cv::Vec3b>(1, 1), cv::Vec3b(30, 20, 10));
  EXPECT_EQ(frame.views[1].color.at<cv::Vec3b>(1, 1), cv::Vec3b(49, 34, 19));
}

TEST(Synthetic, GivesTheDepthOfModelsAndBackgroundWhereItIsAskedFor) {
  const std::string wall = "background: {kind: procedural, distance_mm: 1400, clutter: 0}\n";
  Loaded loaded(std::string(kCameras) + kMotion + wall +
                "frames: 1\ndepth: true\nsensor: {depth_step_mm: 0}\n");
  const std::vector<Camera> cameras = loaded.source->cameras();
  const Frame frame = loaded.frames()[0];
  Renderer renderer(loaded.scene);
  for (std::size_t v = 0; v < 2; ++v) {
    const View& view = frame.views[v];
    ASSERT_EQ(view.depth.type(), CV_32FC1);
    const RenderedView expected = renderer.render(frame.truth->state, cameras[v], {});
    cv::Mat model = cv::Mat::zeros(view.depth.size(), CV_32F);
    view.depth.copyTo(model, view.mask);
    EXPECT_TRUE(same(model, expected.depth));
    cv::Mat behind(view.depth.size(), CV_32F, cv::Scalar(1.4));
    view.depth.copyTo(behind, view.mask == 0);
    EXPECT_LT(cv::norm(behind, cv::Mat(behind.size(), CV_32F, cv::Scalar(1.4)), cv::NORM_INF),
              1e-3);
  }
  const std::string plain = std::string(kCameras) + kMotion + kPlain + "frames: 1\n";
  EXPECT_TRUE(load(plain).frames()[0].views[0].depth.empty());
  const View without_wall = load(plain + "depth: true\n").frames()[0].views[0];
  EXPECT_TRUE(same(without_wall.depth > 0, without_wall.mask)) << "a colour has no depth";
}

TEST(Synthetic, MakesDepthNoisyWithTheSquareOfTheDistanceAndRoundsIt) {
  for (const double distance : {1.0, 2.0}) {
    const std::string yaml = std::string(kCameras) + kMotion + "frames: 2\ndepth: true\n" +
                             "background: {kind: procedural, clutter: 0, distance_mm: " +
                             std::to_string(1000 * distance) +
                             "}\nsensor: {depth_noise_mm: 5, depth_step_mm: 0.5}\n";
    const std::vector<Frame> frames = load(yaml).frames();
    const cv::Mat wall = frames[0].views[0].depth(cv::Rect(0, 0, 60, 200));
    cv::Scalar mean, deviation;
    cv::meanStdDev(wall, mean, deviation);
    EXPECT_NEAR(mean[0], distance, 1e-3);
    EXPECT_NEAR(deviation[0], 0.005 * distance * distance, 0.0003 * distance * distance);
    for (int x = 0; x < wall.cols; ++x) {
      const double steps = wall.at<float>(7, x) / 0.0005;
      EXPECT_NEAR(steps, std::round(steps), 1e-3);
    }
    EXPECT_TRUE(same(frames[0].views[1].depth, load(yaml).frames()[0].views[1].depth));
    EXPECT_FALSE(same(frames[0].views[0].depth, frames[1].views[0].depth));
  }
}

TEST(Synthetic, IsADepthCameraWithOneView) {
  Loaded loaded("cameras: {count: 1, width: 160, height: 100, focal_px: 90}\ndepth: true\n" +
                std::string(kMotion) + "frames: 1\n");
  const Frame frame = loaded.frames()[0];
  ASSERT_EQ(frame.views.size(), 1U);
  EXPECT_EQ(frame.views[0].depth.size(), cv::Size(160, 100));
  EXPECT_EQ(cv::countNonZero(frame.views[0].depth), 160 * 100);
}

TEST(Synthetic, TakesPicturesThroughALens) {
  const std::string yaml =
      "cameras: {width: 320, height: 200, focal_px: 175, distortion: [-0.2, 0.05, 0, 0]}\n" +
      std::string(kQuiet) + kMotion + "frames: 1\n";
  Loaded loaded(yaml);
  const Camera camera = loaded.source->cameras()[0];
  EXPECT_EQ(camera.distortion_model, DistortionModel::brown);
  const Frame frame = loaded.frames()[0];
  const Eigen::Vector2d box = project(camera, {0.1, 0, 0.5});
  EXPECT_NE(frame.views[0].mask.at<unsigned char>(cvRound(box.y()), cvRound(box.x())), 0);
  EXPECT_EQ(cv::countNonZero(frame.views[0].color.reshape(1) == 0), 0)
      << "the wall fills the picture";
}

TEST(Synthetic, TakesTheCamerasOfACalibration) {
  const TemporaryDirectory folder;
  const std::filesystem::path file = folder.path() / "rig.yaml";
  std::ofstream(file) << "%YAML:1.0\n---\nunits: mm\ncameras:\n"
                         "  - {image_width: 200, image_height: 150, model: none, "
                         "K: [180, 0, 99, 0, 181, 76, 0, 0, 1]}\n"
                         "  - {image_width: 210, image_height: 140, model: none, "
                         "K: [170, 0, 101, 0, 172, 70, 0, 0, 1], R: [1, 0, 0, 0, 1, 0, 0, 0, 1], "
                         "T: [-80, 0, 0]}\n";
  const std::string calibration = "calibration: {file: " + file.string() + "}\n";
  Loaded loaded(calibration + kQuiet + kPlain + kMotion + "frames: 1\n");
  ASSERT_EQ(loaded.source->cameras().size(), 2U);
  EXPECT_EQ(loaded.source->cameras()[1].fy, 172);
  EXPECT_NEAR(loaded.source->cameras()[1].camera_from_world.translation().x(), -0.08, 1e-12);
  const Frame frame = loaded.frames()[0];
  EXPECT_EQ(frame.views[0].color.size(), cv::Size(200, 150));
  EXPECT_EQ(frame.views[1].mask.size(), cv::Size(210, 140));
}

TEST(Synthetic, CanBeRepeatedFromWhatItResolvedTo) {
  Loaded loaded(std::string(kCameras) + kMotion + "frames: 1\n");
  std::string resolved;
  const ConfigNode config = ConfigNode::parse(
      "type: synthetic\n" + std::string(kCameras) + kMotion + "frames: 1\n", "a.yaml");
  loaded.plugins.make<Source>(config, &loaded.scene, {}, &resolved);
  const auto again =
      loaded.plugins.make<Source>(ConfigNode::parse(resolved, "resolved.yaml"), &loaded.scene);
  const std::vector<Frame> frames = loaded.frames();
  const std::optional<Frame> frame = again->next();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->truth->state, frames[0].truth->state);
  EXPECT_TRUE(same(frame->views[1].color, frames[0].views[1].color)) << resolved;
}

const char* const kHold = R"(
keyframes:
  - frame: 0
    pose:
      hand: {position_mm: [-20, 60, 420], rotation_deg: [0, 170, 0]}
      box: {position_mm: [0, 0, 450], rotation_deg: [0, 20, 0]}
  - {frame: 2, hold: {box: hand}}
  - {frame: 5, pose: {hand: {position_mm: [40, 30, 500], rotation_deg: [30, 150, 0]}}}
  - {frame: 7, release: [box]}
  - frame: 10
    pose:
      hand: {position_mm: [-20, 60, 420], rotation_deg: [0, 170, 0]}
      box: {position_mm: [50, 0, 450]}
)";

Eigen::Isometry3d place(const Scene& scene, const Frame& frame, std::size_t model) {
  return world_from_model(scene.part(scene.items()[model], frame.truth->state));
}

TEST(Synthetic, MovesAHeldModelWithItsHolderAndLeavesItWhereItIsReleased) {
  Loaded loaded(std::string(kCameras) + kQuiet + kPlain + kHold);
  const std::vector<Frame> frames = loaded.frames();
  const auto hand = [&](std::size_t f) { return place(loaded.scene, frames[f], 0); };
  const auto box = [&](std::size_t f) { return place(loaded.scene, frames[f], 1); };
  EXPECT_TRUE(box(1).isApprox(box(0), 1e-12));
  EXPECT_FALSE(hand(1).isApprox(hand(0), 1e-3));
  const Eigen::Isometry3d grip = hand(2).inverse() * box(0);
  for (std::size_t f = 2; f <= 7; ++f) {
    EXPECT_TRUE(box(f).isApprox(hand(f) * grip, 1e-9)) << f;
  }
  EXPECT_GT((box(7).translation() - box(0).translation()).norm(), 0.02);
  EXPECT_FALSE(box(9).isApprox(hand(9) * grip, 1e-3));
  EXPECT_LT((box(10).translation() - Eigen::Vector3d(0.05, 0, 0.45)).norm(), 1e-12);
  EXPECT_TRUE(box(10).linear().isApprox(box(7).linear(), 1e-9)) << "no key turned it";
  for (std::size_t f = 1; f < frames.size(); ++f) {
    const auto q = [&](std::size_t k) { return frames[k].truth->state.segment<4>(30); };
    EXPECT_GT(q(f).dot(q(f - 1)), 0.9) << f;
  }
}

TEST(Synthetic, HoldsToTheEndWithoutARelease) {
  std::string yaml = kHold;
  yaml.resize(yaml.find("  - {frame: 7"));
  Loaded loaded(std::string(kCameras) + kQuiet + kPlain + yaml + "frames: 9\n");
  const std::vector<Frame> frames = loaded.frames();
  const Eigen::Isometry3d grip =
      place(loaded.scene, frames[2], 0).inverse() * place(loaded.scene, frames[2], 1);
  const Frame& last = frames.back();
  EXPECT_TRUE(place(loaded.scene, last, 1).isApprox(place(loaded.scene, last, 0) * grip, 1e-9));
}

TEST(Synthetic, TakesGesturesFromAFileAfterItsOwn) {
  const TemporaryDirectory folder;
  const std::filesystem::path file = folder.path() / "gestures.yaml";
  std::ofstream(file) << "fist: {index_flexion_1: 80}\nhook: {\"*_flexion_2\": 40}\n";
  const std::string start =
      "{time: 0, gesture: hook, pose: {hand: {position_mm: [0, 0, 400]}, "
      "box: {position_mm: [0, 0, 500]}}}";
  const std::string yaml = std::string(kCameras) + kQuiet + "gesture_file: " + file.string() +
                           "\ngestures: {fist: {index_flexion_1: 50}}\nkeyframes:\n- " + start +
                           "\n- {frame: 1, gesture: fist}\n";
  Loaded loaded(yaml);
  const std::vector<Frame> frames = loaded.frames();
  const auto value = [&](std::size_t f, const std::string& name) {
    return frames[f].truth->state[parameter(loaded.scene, name)] / kDegree;
  };
  EXPECT_NEAR(value(0, "hand.index_flexion_2"), 40, 1e-9);
  EXPECT_NEAR(value(1, "hand.index_flexion_1"), 50, 1e-9) << "the scene's own comes first";
}

TEST(Synthetic, ExplainsWhatIsWrongWithAScript) {
  const std::string start =
      "{time: 0, pose: {hand: {position_mm: [0, 0, 400]}, box: {position_mm: [0, 0, 500]}}}";
  EXPECT_THAT(message_of("keyframes: []\n"),
              AllOf(HasSubstr("scene.yaml:3"), HasSubstr("at least one keyframe")));
  EXPECT_THAT(message_of("keyframes: [{time: 0, pose: {hand: {position_mm: [0, 0, 400]}}}]\n"),
              AllOf(HasSubstr("scene.yaml:3"), HasSubstr("where 'box' is")));
  EXPECT_THAT(message_of("keyframes:\n- " + start + "\n- {time: 0}\n"),
              AllOf(HasSubstr("scene.yaml:5"), HasSubstr("times must ascend")));
  EXPECT_THAT(message_of("keyframes:\n- " + start + "\n- {frame: 2147483647}\n"),
              HasSubstr("2.14748e+09 frames, expected at most 10000000"));
  EXPECT_THAT(message_of("gestures: {fist: {index_flexion_1: 20}}\nkeyframes:\n- " + start +
                         "\n- {time: 1, gesture: {box: fist}}\n"),
              HasSubstr("no joint angle of 'box' is called 'index_flexion_1'; there are: none"));
  EXPECT_THAT(message_of("keyframes:\n- " + start + "\n- {gesture: rest}\n"),
              AllOf(HasSubstr("scene.yaml:5"), HasSubstr("either `time` (seconds) or `frame`")));
  EXPECT_THAT(message_of("keyframes:\n- " + start + "\n- {time: 1, gesture: wave}\n"),
              AllOf(HasSubstr("scene.yaml:5:"), HasSubstr("no gesture is called 'wave'"),
                    HasSubstr("rest")));
  EXPECT_THAT(message_of("keyframes:\n- " + start + "\n- {time: 1, gesture: {foot: rest}}\n"),
              AllOf(HasSubstr("'foot' is no model"), HasSubstr("hand, box")));
  EXPECT_THAT(message_of("gestures: {far: {index_flexion_1: 120}}\nkeyframes:\n- " + start +
                         "\n- {time: 1, gesture: {hand: far}}\n"),
              AllOf(HasSubstr("scene.yaml:3:"), HasSubstr("'index_flexion_1' to 120 deg"),
                    HasSubstr("allows")));
  EXPECT_THAT(
      message_of("gestures: {odd: {\"index_curl*\": 10}}\nkeyframes:\n- " + start +
                 "\n- {time: 1, gesture: odd}\n"),
      AllOf(HasSubstr("scene.yaml:3:"), HasSubstr("'index_curl*'"), HasSubstr("index_flexion_1")));
  EXPECT_THAT(message_of("keyframes:\n- " + start +
                         "\n- {time: 1, pose: {hand: {angles_deg: {index_flexion_1: 500}}}}\n"),
              AllOf(HasSubstr("scene.yaml:5:"), HasSubstr("500")));
}

TEST(Synthetic, ExplainsWhatIsWrongWithAHold) {
  const std::string start =
      "keyframes:\n- {time: 0, pose: {hand: {position_mm: [0, 0, 400]}, "
      "box: {position_mm: [0, 0, 500]}}}\n";
  EXPECT_THAT(message_of(start + "- {time: 1, hold: {bax: hand}}\n"),
              AllOf(HasSubstr("scene.yaml:5:"), HasSubstr("'bax' is no model")));
  EXPECT_THAT(message_of(start + "- {time: 1, release: [box]}\n"),
              AllOf(HasSubstr("scene.yaml:5:"), HasSubstr("'box' is not held here")));
  EXPECT_THAT(message_of(start + "- {time: 1, hold: {box: hand}}\n"
                                 "- {time: 2, pose: {box: {position_mm: [0, 0, 400]}}}\n"),
              AllOf(HasSubstr("scene.yaml:6:"), HasSubstr("'box' is held by 'hand' here")));
  EXPECT_THAT(message_of(start + "- {time: 1, hold: {box: hand}}\n"
                                 "- {time: 2, hold: {box: hand}}\n"),
              AllOf(HasSubstr("scene.yaml:6:"), HasSubstr("'box' is held already")));
  EXPECT_THAT(message_of(start + "- {time: 1, hold: {box: hand, hand: box}}\n"),
              AllOf(HasSubstr("scene.yaml:5:"), HasSubstr("must not be held itself")));
}

TEST(Synthetic, ExplainsWhatIsWrongWithCamerasBackgroundAndSensor) {
  const std::string motion = kMotion;
  EXPECT_THAT(
      message_of(motion + "sensor: {gain: [1, 1, 1]}\n"),
      AllOf(HasSubstr("scene.yaml"), HasSubstr("sensor.gain has 3 numbers"), HasSubstr("2")));
  EXPECT_THAT(message_of(motion + "background: {kind: image, file: /nowhere.png}\n"),
              AllOf(HasSubstr("/nowhere.png"), HasSubstr("is no readable image")));
  EXPECT_THAT(message_of(motion + "background: {kind: image}\n"), HasSubstr("needs `file`"));
  EXPECT_THAT(message_of(motion + "colour: red\n"),
              AllOf(HasSubstr("scene.yaml"), HasSubstr("colour")));
}

TEST(Synthetic, BlursWhatMovesDuringTheExposureOnly) {
  const std::string scene = std::string(kCameras) + kPlain + kMotion;
  const auto frames = [&](const std::string& sensor) {
    return load(scene + "sensor: {noise_sigma: 0" + sensor + "}\n").frames();
  };
  const std::vector<Frame> sharp = frames(""), blurred = frames(", exposure_s: 0.03");
  for (std::size_t v = 0; v < 2; ++v) {
    const View &a = sharp[5].views[v], &b = blurred[5].views[v];
    EXPECT_TRUE(same(a.mask, b.mask));
    cv::Mat difference;
    cv::absdiff(a.color, b.color, difference);
    EXPECT_GT(cv::mean(difference, a.mask)[1], 1);
    EXPECT_EQ(b.color.at<cv::Vec3b>(1, 1), cv::Vec3b(30, 20, 10));
    EXPECT_NEAR(cv::mean(a.color)[1], cv::mean(b.color)[1], 0.3) << "as bright";
  }
  EXPECT_EQ(sharp[5].truth->state, blurred[5].truth->state);
  const std::string still = std::string(kCameras) + kPlain +
                            "keyframes: [{time: 0, pose: {hand: {position_mm: [0, 0, 400]}, box: "
                            "{position_mm: [100, 0, 500]}}}]\nsensor: {noise_sigma: 0";
  EXPECT_TRUE(same(load(still + "}\n").frames()[0].views[0].color,
                   load(still + ", exposure_s: 0.03}\n").frames()[0].views[0].color));
}

TEST(Synthetic, RefusesAnExposureLongerThanAFrame) {
  EXPECT_THAT(message_of(std::string(kMotion) + "sensor: {exposure_s: 0.04}\n"),
              AllOf(HasSubstr("scene.yaml:"), HasSubstr("sensor.exposure_s is 0.04 s"),
                    HasSubstr("0.0333333 s")));
}

}  // namespace
}  // namespace hypotrack::test
