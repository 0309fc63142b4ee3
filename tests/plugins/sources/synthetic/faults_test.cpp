// What is wrong with the synthetic source's frames on request.

#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "synthetic_fixture.hpp"

namespace hypotrack::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::string kMoving = std::string(kCameras) + kQuiet + kPlain + kMotion + "frames: 5\n";

std::vector<Frame> frames_with(const std::string& faults, const std::string& more = "") {
  return load(kMoving + more + "faults: [" + faults + "]\n").frames();
}

TEST(Faults, AbsentModelsAndTheirForearmsAreNotDrawn) {
  const std::string sleeve = "forearm: {kind: sleeve}\n";
  const std::vector<Frame> all = frames_with("", sleeve);
  const std::vector<Frame> none = frames_with("{frames: [1, 3], kind: absent}", sleeve);
  const std::vector<Frame> box = frames_with("{frames: [2, 2], kind: absent, model: hand}", sleeve);
  for (std::size_t v = 0; v < 2; ++v) {
    EXPECT_TRUE(same(none[0].views[v].color, all[0].views[v].color));
    EXPECT_EQ(cv::countNonZero(none[2].views[v].mask), 0);
    const cv::Mat plain(200, 320, CV_8UC3, cv::Scalar(30, 20, 10));
    EXPECT_TRUE(same(none[2].views[v].color, plain));
    EXPECT_TRUE(same(none[4].views[v].color, all[4].views[v].color));
    EXPECT_GT(cv::countNonZero(box[2].views[v].mask), 100);
    EXPECT_LT(cv::countNonZero(box[2].views[v].mask),
              cv::countNonZero(all[2].views[v].mask) - 1000);
  }
}

TEST(Faults, TheTruthSaysWhatIsAbsent) {
  Loaded loaded(kMoving + "faults: [{frames: [2, 3], kind: absent, model: hand}]\n");
  const std::vector<Frame> frames = loaded.frames();
  const std::vector<Frame> all = frames_with("");
  EXPECT_THAT(frames[1].truth->absent, IsEmpty());
  EXPECT_EQ(frames[1].truth->landmarks.size(), 0) << "the state says it";
  EXPECT_THAT(frames[2].truth->absent, ElementsAre(true, false));
  const Eigen::Matrix3Xd& landmarks = frames[2].truth->landmarks;
  EXPECT_EQ(frames[2].truth->state, all[2].truth->state) << "the script goes on";
  EXPECT_TRUE(landmarks.leftCols(21).array().isNaN().all());
  EXPECT_TRUE(
      landmarks.rightCols(3).isApprox(loaded.scene.landmarks(frames[2].truth->state).rightCols(3)));
  EXPECT_THAT(frames[4].truth->absent, IsEmpty());
}

TEST(Faults, ViewsAreExchangedBlackenedAndFrozenAndTheTruthStays) {
  const std::vector<Frame> all = frames_with("");
  const std::vector<Frame> exchanged = frames_with("{frames: [1, 2], kind: exchanged}");
  const std::vector<Frame> black = frames_with("{frames: [1, 1], kind: black}");
  const std::vector<Frame> frozen = frames_with("{frames: [2, 3], kind: frozen, view: 1}");
  EXPECT_TRUE(same(exchanged[2].views[0].color, all[2].views[1].color));
  EXPECT_TRUE(same(exchanged[2].views[1].mask, all[2].views[0].mask));
  EXPECT_TRUE(same(exchanged[3].views[0].color, all[3].views[0].color));
  EXPECT_EQ(cv::countNonZero(black[1].views[0].color.reshape(1)), 0);
  EXPECT_EQ(cv::countNonZero(black[1].views[1].mask), 0);
  EXPECT_TRUE(same(black[2].views[1].color, all[2].views[1].color));
  for (const std::size_t f : {2U, 3U}) {
    EXPECT_TRUE(same(frozen[f].views[0].color, all[f].views[0].color));
    EXPECT_TRUE(same(frozen[f].views[1].color, all[1].views[1].color));
  }
  EXPECT_TRUE(same(frozen[4].views[1].color, all[4].views[1].color));
  for (const std::vector<Frame>* frames : {&exchanged, &black, &frozen}) {
    EXPECT_THAT((*frames)[1].truth->absent, IsEmpty());
    EXPECT_EQ((*frames)[2].truth->state, all[2].truth->state);
  }
}

TEST(Faults, ViewsAreLateMisalignedDarkerAndFrozenWithNoise) {
  const std::vector<Frame> all = frames_with("");
  const std::vector<Frame> late = frames_with(
      "{frames: [0, 9], kind: late, view: 1}, {frames: [3, 3], kind: late, view: 0, by: 3}");
  const std::vector<Frame> lower =
      frames_with("{frames: [1, 2], kind: misaligned, view: 1, shift_px: [0, 4]}");
  const std::vector<Frame> darker =
      frames_with("{frames: [1, 3], kind: exposure, view: 1, gain: 0.5}");
  const std::vector<Frame> frozen =
      frames_with("{frames: [2, 3], kind: frozen, view: 1, noise_sigma: 2}");
  EXPECT_TRUE(same(late[0].views[1].color, all[0].views[1].color));
  for (const std::size_t f : {1U, 2U, 4U}) {
    EXPECT_TRUE(same(late[f].views[0].color, all[f].views[0].color));
    EXPECT_TRUE(same(late[f].views[1].color, all[f - 1].views[1].color));
    EXPECT_EQ(late[f].truth->state, all[f].truth->state);
  }
  EXPECT_TRUE(same(late[3].views[0].color, all[0].views[0].color));
  EXPECT_TRUE(same(lower[1].views[0].color, all[1].views[0].color));
  EXPECT_TRUE(
      same(lower[1].views[1].color.rowRange(4, 200), all[1].views[1].color.rowRange(0, 196)));
  EXPECT_TRUE(same(lower[3].views[1].color, all[3].views[1].color));
  const auto brightness = [](const Frame& frame) {
    return cv::sum(cv::mean(frame.views[1].color))[0];
  };
  EXPECT_EQ(brightness(darker[1]), brightness(all[1]));
  EXPECT_NEAR(brightness(darker[2]), 0.75 * brightness(all[2]), 2);
  EXPECT_NEAR(brightness(darker[4]), 0.5 * brightness(all[4]), 2);
  cv::Mat noise[2];
  for (const std::size_t f : {2U, 3U})
    cv::absdiff(frozen[f].views[1].color, all[1].views[1].color, noise[f - 2]);
  EXPECT_GT(cv::countNonZero(noise[0].reshape(1)), 100000);
  EXPECT_LT(cv::mean(noise[0])[0], 3);
  EXPECT_FALSE(same(noise[0], noise[1]));
}

TEST(Faults, MissingFramesLeaveAGapInTimeAndNotInTheNumbers) {
  Loaded loaded(kMoving +
                "faults: [{frames: [1, 2], kind: missing}, {frames: [4, 9], kind: missing}]\n");
  EXPECT_EQ(loaded.source->frame_count(), 2);
  const std::vector<Frame> frames = loaded.frames();
  const std::vector<Frame> all = frames_with("");
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[1].index, 1);
  EXPECT_EQ(frames[1].time, all[3].time);
  EXPECT_EQ(frames[1].truth->state, all[3].truth->state);
  EXPECT_TRUE(same(frames[1].views[1].color, all[3].views[1].color));
}

TEST(Faults, RepeatThePictureBeforeMissingFrames) {
  const std::vector<Frame> all = frames_with("");
  const std::vector<Frame> frames =
      frames_with("{frames: [2, 2], kind: missing}, {frames: [2, 3], kind: frozen}");
  ASSERT_EQ(frames.size(), 4U);
  EXPECT_TRUE(same(frames[2].views[0].color, all[1].views[0].color));
  EXPECT_TRUE(same(frames[3].views[0].color, all[4].views[0].color));
}

TEST(Faults, MayHaveEmptyKeysOfOtherKinds) {  // as run.yaml has them
  EXPECT_EQ(frames_with("{frames: [1, 2], kind: black, model: ''}, "
                        "{frames: [3, 3], kind: absent, model: hand}")
                .size(),
            5);
}

TEST(Faults, ExplainWhatIsWrongWithThem) {
  const auto message = [](const std::string& fault, const std::string& more = "") {
    return message_of(kMotion + more + "faults:\n- " + fault + "\n");
  };
  EXPECT_THAT(message("{kind: black}"), AllOf(HasSubstr("scene.yaml:"), HasSubstr("frames")));
  EXPECT_THAT(message("{frames: [1, 2], kind: blank}"),
              AllOf(HasSubstr("scene.yaml:15:"), HasSubstr("black")));
  EXPECT_THAT(message("{frames: [3, 2], kind: black}"),
              AllOf(HasSubstr("scene.yaml:15:"), HasSubstr("frames are 3 to 2")));
  EXPECT_THAT(message("{frames: [1, 2.5], kind: black}"), HasSubstr("frames are 1 to 2.5"));
  EXPECT_THAT(message("{frames: [1, 2], kind: absent, model: foot}"),
              AllOf(HasSubstr("scene.yaml:15:"), HasSubstr("'foot' is no model of this scene")));
  EXPECT_THAT(message("{frames: [1, 2], kind: black, model: hand}"),
              HasSubstr("`model` belongs to the kind absent; leave it out of the kind black"));
  EXPECT_THAT(message("{frames: [1, 2], kind: absent, view: 1}"),
              HasSubstr("`view` belongs to the kind frozen"));
  EXPECT_THAT(message("{frames: [1, 2], kind: frozen, view: 1, gain: 0.5}"),
              HasSubstr("`gain` belongs to the kind exposure; leave it out of the kind frozen"));
  EXPECT_THAT(message("{frames: [0, 2], kind: missing}"), HasSubstr("frame 0 cannot be missing"));
  EXPECT_THAT(message("{frames: [0, 2], kind: frozen}"),
              HasSubstr("no picture comes before frame 0"));
  const std::string one = "type: synthetic\ncameras: {count: 1}\n" + std::string(kMotion);
  const auto with_one = [&](const std::string& fault) {
    PluginLoader plugins;
    const Scene scene = hand_and_box();
    try {
      plugins.make<Source>(ConfigNode::parse(one + "faults: [" + fault + "]\n", "scene.yaml"),
                           &scene);
    } catch (const ConfigError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_THAT(with_one("{frames: [1, 2], kind: exchanged}"), HasSubstr("only two cameras"));
  EXPECT_THAT(with_one("{frames: [1, 2], kind: frozen, view: 1}"), HasSubstr("one view only"));
}

}  // namespace
}  // namespace hypotrack::test
