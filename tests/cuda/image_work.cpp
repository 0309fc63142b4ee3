#include "image_work.hpp"

#include <atomic>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <random>
#include <thread>
#include <vector>

namespace hypotrack::test {
namespace {

bool is_all(const cv::Mat& image, int value) {
  return cv::countNonZero(image.reshape(1) != value) == 0;
}

/// One image's life; whether all that was made of it holds what it should.
bool lives(int width, int height, int value) {
  cv::Mat image(height, width, CV_8UC3, cv::Scalar::all(value));
  const cv::Mat clone = image.clone();
  const cv::Rect inside(width / 4, height / 4, width / 2, height / 2);
  image(inside).setTo(cv::Scalar::all(255 - value));
  cv::Mat larger;
  cv::resize(clone, larger, {width + 31, height + 17});
  cv::Mat wide;
  clone.convertTo(wide, CV_32F);
  const cv::Mat part = image(inside);
  const bool kept = is_all(clone, value) && is_all(larger, value) && is_all(wide, value);
  image.create(height + 5, width + 5, CV_16U);  // the part goes on living
  image.setTo(cv::Scalar::all(value));
  return kept && is_all(part.clone(), 255 - value) && is_all(image, value);
}

}  // namespace

int damaged_images(int threads, int rounds) {
  std::atomic<int> damaged = 0;
  const auto work = [&](int thread) {
    std::mt19937 random(static_cast<unsigned>(thread));
    for (int i = 0; i < rounds; ++i) {
      const int width = 100 + static_cast<int>(random() % 400);
      const int height = 80 + static_cast<int>(random() % 300);
      damaged += lives(width, height, thread + 1) ? 0 : 1;
    }
  };
  std::vector<std::thread> running;
  running.reserve(static_cast<std::size_t>(threads));
  for (int i = 0; i < threads; ++i) running.emplace_back(work, i);
  for (std::thread& thread : running) thread.join();
  return damaged;
}

}  // namespace hypotrack::test
