#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "window/window.hpp"

namespace hypotrack::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// Without a display that can be reached.
class DisplayTest : public testing::Test {
 protected:
  void SetUp() override {
    setenv("DISPLAY", ":98765", 1);
    for (const char* name : {"WAYLAND_DISPLAY", "QT_QPA_PLATFORM"}) unsetenv(name);
  }
};

TEST_F(DisplayTest, AMissingDisplayIsAnErrorThatSaysWhatToDo) {
  const auto check = [] { check_display("do this"); };
  EXPECT_THAT(message_of<DeviceError>(check),
              AllOf(HasSubstr(":98765 cannot be reached"), HasSubstr("or do this")));
  unsetenv("DISPLAY");
  EXPECT_THAT(message_of<DeviceError>(check), HasSubstr("neither DISPLAY nor WAYLAND_DISPLAY"));
}

TEST_F(DisplayTest, AnUnknownScreenCountsAsASmallOne) {
  EXPECT_EQ(screen_size(), cv::Size(1280, 720));
}

TEST_F(DisplayTest, AWindowsProcessThatFailsSaysWhy) {
  WindowContent content;
  content.title = "window";
  content.size = {300, 200};
  content.picture = [](cv::Size area) { return cv::Mat(area, CV_8UC3, cv::Scalar::all(0)); };
  content.on_key = [](char) { return WindowStep::wait; };
  content.next = [] { return WindowStep::wait; };
  EXPECT_THAT(message_of<DeviceError>([&] { show_in_process(content); }),
              AllOf(HasSubstr("the window's process ended with code"), HasSubstr("display")));
}

}  // namespace
}  // namespace hypotrack::test
