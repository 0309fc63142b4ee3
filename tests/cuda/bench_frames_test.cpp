#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <vector>

#include "cost/cuda/memory/pooled_mat_allocator.hpp"
#include "lab/bench/frames.hpp"
#include "pool_on_host.hpp"

namespace hypotrack::cuda {
namespace {

TEST(BenchFrames, AreMovedOnceToWhereImagesAreMade) {
  test::PoolOnHost host{64 << 20};
  PooledMatAllocator allocator{host.pool};
  const auto pooled = [&](const cv::Mat& image) { return host.owns(image.data); };
  cv::MatAllocator* before = cv::Mat::getDefaultAllocator();
  std::vector<Frame> frames(2);
  frames[1].views.push_back({.color = cv::Mat(300, 400, CV_8UC3, cv::Scalar::all(5)),
                             .mask = cv::Mat(300, 400, CV_8U, cv::Scalar(6))});
  cv::Mat::setDefaultAllocator(&allocator);
  View& view = frames[1].views[0];
  EXPECT_FALSE(pooled(view.color));
  bench::renew_images(frames);
  EXPECT_TRUE(pooled(view.color) && pooled(view.mask) && view.depth.empty());
  EXPECT_EQ(cv::countNonZero(view.color.reshape(1) != 5), 0);
  EXPECT_EQ(cv::countNonZero(view.mask != 6), 0);
  const unsigned char* data = view.color.data;
  bench::renew_images(frames);
  EXPECT_EQ(view.color.data, data);
  cv::Mat::setDefaultAllocator(before);
}

}  // namespace
}  // namespace hypotrack::cuda
