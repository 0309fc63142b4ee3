// Equal pictures give equal results.
#include <opencv2/core.hpp>
#include <thread>

#include "pictures.hpp"

namespace hypotrack {
namespace {

void expect_equal(const std::vector<HandDetection>& a, const std::vector<HandDetection>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].landmarks, b[i].landmarks);
    EXPECT_EQ(a[i].relative, b[i].relative);
    EXPECT_EQ(a[i].presence, b[i].presence);
    EXPECT_EQ(a[i].palm_score, b[i].palm_score);
    EXPECT_EQ(a[i].right, b[i].right);
  }
}

/// Restores OpenCV's number of threads.
class ThreadCount {
 public:
  ThreadCount() : before_(cv::getNumThreads()) {}
  ~ThreadCount() { cv::setNumThreads(before_); }

 private:
  int before_;
};

TEST(RepeatedDetection, GivesTheSameWithEveryNumberOfThreads) {
#ifdef __SANITIZE_THREAD__
  GTEST_SKIP() << "OpenCV's loops wait for their threads in code that the sanitizer does not see";
#endif
  HYPOTRACK_NEEDS_HAND_DETECTOR();
  const cv::Mat picture = test::rendered_hand().picture();
  const ThreadCount restored;
  for (const bool lite : {false, true}) {
    HandDetector detector({.lite = lite});
    const auto first = detector.detect(picture);
    ASSERT_EQ(first.size(), 1u);
    for (const int threads : {1, 2, 3, 7, 16}) {
      cv::setNumThreads(threads);
      expect_equal(detector.detect(picture), first);
      EXPECT_EQ(cv::getNumThreads(), threads);
      const HandPoints& guess = first.front().landmarks;
      expect_equal({*detector.follow(picture, guess, threads)}, {*detector.follow(picture, guess)});
    }
  }
}

TEST(RepeatedDetection, DoesNotDependOnEarlierPictures) {
  HYPOTRACK_NEEDS_HAND_DETECTOR();
  const cv::Mat picture = test::rendered_hand().picture();
  HandDetector fresh({}), used({});
  cv::Mat mirrored;
  cv::flip(picture, mirrored, 1);
  const auto first = fresh.detect(picture);
  used.detect(mirrored);
  used.detect(cv::Mat(480, 640, CV_8UC1, cv::Scalar(128)));
  ASSERT_EQ(first.size(), 1u);
  used.refine(mirrored, first.front().landmarks);
  expect_equal(used.detect(picture), first);
  expect_equal(used.detect(picture), first);
}

TEST(RepeatedDetection, GivesTheSameInThreadsThatShareADetector) {
  HYPOTRACK_NEEDS_HAND_DETECTOR();
  const cv::Mat picture = test::rendered_hand().picture();
  const HandDetector detector({});
  const auto first = detector.detect(picture);
  ASSERT_EQ(first.size(), 1u);
  std::vector<std::optional<HandDetection>> followed(4);
  {
    std::vector<std::jthread> threads;
    for (auto& hand : followed) {
      threads.emplace_back([&] { hand = detector.follow(picture, first.front().landmarks); });
    }
  }
  for (const auto& hand : followed) {
    ASSERT_TRUE(hand);
    expect_equal({*hand}, {*detector.follow(picture, first.front().landmarks)});
  }
}

TEST(RepeatedDetection, LeavesThePictureAlone) {
  HYPOTRACK_NEEDS_HAND_DETECTOR();
  const cv::Mat picture = test::rendered_hand().picture();
  const cv::Mat before = picture.clone();
  HandDetector({}).detect(picture);
  EXPECT_EQ(cv::norm(picture, before, cv::NORM_INF), 0);
}

}  // namespace
}  // namespace hypotrack
