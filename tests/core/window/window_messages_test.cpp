#include "window/window_messages.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <future>
#include <opencv2/core.hpp>

namespace hypotrack {
namespace {

class WindowMessagesTest : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends_.data()), 0);
  }
  void TearDown() override {
    for (const int end : ends_) close(end);
  }

  std::array<int, 2> ends_{};
};

TEST_F(WindowMessagesTest, QuestionsAndStepsArriveAsTheyWereSent) {
  ASSERT_TRUE(send_question(ends_[0],
                            {.kind = WindowQuestion::Kind::picture, .width = 300, .height = 200}));
  ASSERT_TRUE(send_question(ends_[0], {.kind = WindowQuestion::Kind::key, .key = 'v'}));
  bool late = true;
  const auto picture = receive_question(ends_[1], std::chrono::milliseconds(0), late);
  ASSERT_TRUE(picture);
  EXPECT_FALSE(late);
  EXPECT_EQ(picture->kind, WindowQuestion::Kind::picture);
  EXPECT_EQ(cv::Size(picture->width, picture->height), cv::Size(300, 200));
  EXPECT_EQ(receive_question(ends_[1], std::chrono::milliseconds(0), late)->key, 'v');
  ASSERT_TRUE(send_step(ends_[1], WindowStep::close));
  EXPECT_EQ(receive_step(ends_[0]), WindowStep::close);
}

TEST_F(WindowMessagesTest, AQuestionMayBeLate) {
  bool late = false;
  EXPECT_FALSE(receive_question(ends_[1], std::chrono::milliseconds(1), late));
  EXPECT_TRUE(late);
}

TEST_F(WindowMessagesTest, PicturesLargerThanTheSocketsBuffersArrive) {
  cv::Mat large(1200, 1900, CV_8UC3);
  cv::randu(large, 0, 255);
  const cv::Mat part = large(cv::Rect(50, 60, 1800, 1100));  // with gaps between its rows
  const auto sent = std::async(std::launch::async, [&] { return send_picture(ends_[0], part); });
  const auto received = receive_picture(ends_[1]);
  ASSERT_TRUE(received);
  EXPECT_EQ(cv::norm(*received, part, cv::NORM_INF), 0);
}

TEST_F(WindowMessagesTest, TheEndOfTheOtherSideIsNoticed) {
  shutdown(ends_[0], SHUT_RDWR);
  bool late = true;
  EXPECT_FALSE(receive_question(ends_[1], std::chrono::milliseconds(0), late));
  EXPECT_FALSE(late);
  EXPECT_FALSE(receive_step(ends_[1]));
  EXPECT_FALSE(receive_picture(ends_[1]));
  EXPECT_FALSE(send_step(ends_[1], WindowStep::wait));
}

}  // namespace
}  // namespace hypotrack
