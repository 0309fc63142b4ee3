// How a sequence fits its scene: files that exist, true states, the calibration.

#include <gmock/gmock.h>

#include "hypotrack/api/error.hpp"
#include "hypotrack/api/tables.hpp"
#include "image_sequence_fixture.hpp"

namespace hypotrack {
namespace {

using test::ImageSequence;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST_F(ImageSequence, SaysWhichPicturesAreMissingFromTheScene) {
  write_pair(0);
  EXPECT_THAT(making("type: image_sequence\ncalibration: {file: rig.yml}\n"),
              ThrowsMessage<ConfigError>(
                  AllOf(HasSubstr("scene.yaml:1"), HasSubstr("neither left nor left_depth"))));
  EXPECT_THAT(making("type: image_sequence\nleft: left_%04d.png\nright_mask: left_%04d.png\n"
                     "calibration: {file: rig.yml}\n"),
              ThrowsMessage<ConfigError>(HasSubstr("right_mask is given without images")));
  EXPECT_THAT(making(numbered("right_depth: right_%04d.png\n")),
              ThrowsMessage<DataError>(AllOf(HasSubstr("no image can be read"),
                                             HasSubstr("right_0000.png: has 8-bit pixels"))));
  write_image(file("d_0000.png").string(), cv::Mat(24, 32, CV_16U, cv::Scalar(50)));
  EXPECT_THAT(making(numbered("left_depth: d_%04d.png\n")),
              ThrowsMessage<DataError>(AllOf(HasSubstr("d_0000.png"), HasSubstr("32x24"))));
}

TEST_F(ImageSequence, KnowsTheAnswerWhereTablesGiveIt) {
  for (int i = 0; i < 3; ++i) write_pair(i);
  Eigen::VectorXd state = scene_.rest_state();
  state[2] = 0.5;
  write_states(file("states.csv"), scene_, std::vector<StateRow>{{0, 0, state}, {2, 0.1, state}});
  const std::string name = scene_.landmark_names()[0];
  write("landmarks.csv", "frame," + name + "_x," + name + "_y," + name + "_z\n1,10,20,30\n");
  const auto source = make(numbered("truth_states: states.csv\ntruth_landmarks: landmarks.csv\n"
                                    "truth_units: mm\n"),
                           &scene_);
  const auto first = source->next();
  ASSERT_TRUE(first->truth);
  EXPECT_EQ(first->truth->state, state);
  EXPECT_EQ(first->truth->landmarks.size(), 0);
  const auto second = source->next();
  ASSERT_TRUE(second->truth);
  EXPECT_EQ(second->truth->state.size(), 0);
  EXPECT_NEAR(second->truth->landmarks(1, 0), 0.02, 1e-15);
}

TEST_F(ImageSequence, FindsTheAnswerByTheNumberOfTheImage) {
  for (int i = 0; i < 9; ++i) write_pair(i);
  Eigen::VectorXd state = scene_.rest_state();
  std::vector<StateRow> rows;
  for (int i = 0; i < 9; ++i) {
    state[2] = i;
    rows.push_back({i, i / 30.0, state});
  }
  write_states(file("states.csv"), scene_, rows);
  const auto source = make(numbered("start: 3\nstep: 2\ntruth_states: states.csv\n"), &scene_);
  EXPECT_EQ(source->next()->truth->state[2], 3);
  EXPECT_EQ(source->next()->truth->state[2], 5);
  const auto shifted =
      make(numbered("start: 3\ntruth_states: states.csv\ntruth_offset: -2\n"), &scene_);
  EXPECT_EQ(shifted->next()->truth->state[2], 1);
}

TEST_F(ImageSequence, RefusesAnAnswerToOtherFrames) {
  for (int i = 0; i < 3; ++i) write_pair(i);
  write_states(file("states.csv"), scene_, std::vector<StateRow>{{1, 0, scene_.rest_state()}});
  const auto with = [&](const std::string& more) {
    return [this, more] { make(numbered("truth_states: states.csv\n" + more), &scene_); };
  };
  EXPECT_NO_THROW(with("")());
  EXPECT_THAT(with("truth_offset: 7\n"),
              ThrowsMessage<DataError>(AllOf(HasSubstr("states.csv: has frames 1 to 1"),
                                             HasSubstr("the source's frames, 7 to 9;"))));
  EXPECT_THAT(with("start: 2\n"), ThrowsMessage<DataError>(HasSubstr("frames, 2 to 2;")));
  EXPECT_THAT(with("step: 2\n"), ThrowsMessage<DataError>(HasSubstr("0 to 2 in steps of 2")));
}

TEST_F(ImageSequence, SaysWhatItDidNotFind) {
  EXPECT_THAT(making(numbered()),
              ThrowsMessage<DataError>(
                  AllOf(HasSubstr("no image was found; looked for\n  left_%04d.png in "),
                        HasSubstr(folder_.path().string()), HasSubstr("right_%04d.png"))));
  EXPECT_THAT(making("type: image_sequence\nleft: none/*.png\ncalibration: {file: rig.yml}\n"),
              ThrowsMessage<DataError>(HasSubstr("(no such folder)")));
  write_pair(5);
  EXPECT_THAT(making(numbered("start: 9")),
              ThrowsMessage<DataError>(HasSubstr("the last image has number 5")));
  EXPECT_THAT(making("type: image_sequence\nleft: left_%s.png\ncalibration: {file: rig.yml}\n"),
              ThrowsMessage<DataError>(HasSubstr("the pattern is not understood")));
  EXPECT_THAT(making("type: image_sequence\nleft: left_%04d.png\nright: right_*.png\n"
                     "calibration: {file: rig.yml}\n"),
              ThrowsMessage<DataError>(HasSubstr("only one of the patterns has a number")));
  write_image(file("sparse_1.png").string(), picture(0, 0));
  write_image(file("sparse_2000000000.png").string(), picture(0, 0));
  EXPECT_THAT(making("type: image_sequence\nleft: sparse_%d.png\ncalibration: {file: rig.yml}\n"),
              ThrowsMessage<DataError>(HasSubstr("most frames would be missing")));
}

TEST_F(ImageSequence, SaysThatTheCalibrationDoesNotFit) {
  write_pair(5);
  calibrate(64, 48, 3);
  EXPECT_THAT(making(numbered()),
              ThrowsMessage<DataError>(HasSubstr("holds 3 cameras, the source has 2 views")));
  calibrate(320, 240, 2);
  EXPECT_THAT(making(numbered()),
              ThrowsMessage<DataError>(HasSubstr(
                  "the image is 64x48 pixels, but its camera is calibrated for 320x240")));
  calibrate(64, 48, 2);
  write("right_0005.png", "no picture");
  EXPECT_THAT(making(numbered()), ThrowsMessage<DataError>(HasSubstr("no image can be read: ")));
}

}  // namespace
}  // namespace hypotrack
