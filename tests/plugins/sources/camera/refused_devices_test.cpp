#include <gmock/gmock.h>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "source_fixture.hpp"

namespace hypotrack {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

class RefusedDevices : public test::SourceFixture {
 protected:
  auto making(const std::string& lines) {
    return [this, lines] { make("type: camera\ncalibration: {file: rig.yml}\n" + lines); };
  }
};

TEST_F(RefusedDevices, OneDeviceOrTwoAreExpected) {
  for (const char* lines : {"", "left: 0\n", "right: 0\n", "device: 0\nleft: 1\nright: 2\n"}) {
    EXPECT_THAT(making(lines),
                ThrowsMessage<ConfigError>(HasSubstr("expected either device (one picture of both "
                                                     "views) or left and right")))
        << lines;
  }
  EXPECT_THAT(making("left: 3\nright: 3\n"),
              ThrowsMessage<ConfigError>(HasSubstr("left and right are the same device")));
}

TEST_F(RefusedDevices, AMissingDeviceIsNamedWithThoseThatExist) {
  EXPECT_THAT(
      making("device: 997\n"),
      ThrowsMessage<DataError>(AllOf(HasSubstr("device: /dev/video997: there is no such device; "),
                                     testing::AnyOf(HasSubstr("this machine has no /dev/video*"),
                                                    HasSubstr("expected one of /dev/video")))));
}

TEST_F(RefusedDevices, AFileIsNoDevice) {
  EXPECT_THAT(making("device: " + file("rig.yml").string() + "\n"),
              ThrowsMessage<DataError>(
                  AllOf(HasSubstr("rig.yml: is no device; "), HasSubstr("`video` reads files"))));
}

TEST_F(RefusedDevices, ADeviceThatDeliversNoPicturesIsNoCamera) {
  EXPECT_THAT(making("device: /dev/null\n"),
              ThrowsMessage<DataError>(HasSubstr("/dev/null: cannot be opened as a camera")));
}

TEST_F(RefusedDevices, AStreamThatNobodyServesCannotBeOpened) {
  EXPECT_THAT(making("device: \"http://127.0.0.1:1/stream\"\n"),
              ThrowsMessage<DataError>(AllOf(HasSubstr("http://127.0.0.1:1/stream"),
                                             HasSubstr("the stream cannot be opened"))));
}

TEST_F(RefusedDevices, ThePasswordOfAStreamIsNotShown) {
  const std::string message =
      test::message_of<DataError>(making("device: \"http://me:secret@127.0.0.1:1/stream@home\"\n"));
  EXPECT_THAT(message, AllOf(HasSubstr("device (http://...@127.0.0.1:1/stream@home)"),
                             testing::Not(HasSubstr("secret"))));
}

TEST_F(RefusedDevices, APipelineWithoutASinkCannotBeOpened) {
  EXPECT_THAT(making("device: \"fakesrc ! fakesink\"\n"),
              ThrowsMessage<DataError>(HasSubstr("GStreamer cannot open the pipeline")));
}

TEST_F(RefusedDevices, OnlyV4l2DevicesCanBeSet) {
  const std::string stream = "device: \"http://127.0.0.1:1/stream\"\n";
  for (const char* setting : {"width: 1280", "height: 720", "pixel_format: MJPG", "exposure_ms: 5",
                              "white_balance: 4600"}) {
    EXPECT_THAT(making(stream + setting + "\n"),
                ThrowsMessage<ConfigError>(HasSubstr("only V4L2 devices can be set")))
        << setting;
  }
  EXPECT_THAT(making("device: 997\npixel_format: MJPEG\n"),
              ThrowsMessage<ConfigError>(HasSubstr("pixel_format is 'MJPEG'; expected four")));
}

TEST_F(RefusedDevices, ACalibrationNeedsTwoCameras) {
  calibrate(64, 48, 1);
  EXPECT_THAT(making("device: 997\n"),
              ThrowsMessage<DataError>(HasSubstr("rig.yml: holds 1 cameras; expected two")));
}

}  // namespace
}  // namespace hypotrack
