#include "cost/cuda/memory/pooled_mat_allocator.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <vector>

#include "image_work.hpp"
#include "pool_on_host.hpp"

namespace hypotrack::cuda {
namespace {

/// Images are made in a pool of ordinary memory.
class PooledMats : public ::testing::Test {
 protected:
  PooledMats() { cv::Mat::setDefaultAllocator(&allocator_); }
  ~PooledMats() override { cv::Mat::setDefaultAllocator(before_); }
  bool pooled(const cv::Mat& image) const { return host_.owns(image.data); }

  test::PoolOnHost host_{64 << 20};

 private:
  PooledMatAllocator allocator_{host_.pool};
  cv::MatAllocator* before_ = cv::Mat::getDefaultAllocator();
};

TEST_F(PooledMats, AreThoseOf64KiBAndMore) {
  EXPECT_TRUE(pooled(cv::Mat(256, 256, CV_8U)));
  EXPECT_FALSE(pooled(cv::Mat(256, 255, CV_8U)));
  EXPECT_TRUE(pooled(cv::Mat(480, 640, CV_8UC3)));
  EXPECT_TRUE(pooled(cv::Mat(480, 640, CV_32F)));
  EXPECT_FALSE(pooled(cv::Mat(4, 4, CV_64F)));
  EXPECT_EQ(cv::Mat(0, 640, CV_8U).data, nullptr);
}

TEST_F(PooledMats, HaveOpenCvsLayout) {
  const cv::Mat image(333, 501, CV_8UC3);
  EXPECT_EQ(image.step[0], 1503U);
  EXPECT_EQ(image.step[1], 3U);
  EXPECT_EQ(image.datalimit - image.datastart, 333 * 1503);
  EXPECT_TRUE(image.isContinuous());
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(image.data) % 64, 0U);
  const int sizes[] = {20, 30, 40};
  const cv::Mat cube(3, sizes, CV_32FC2);
  EXPECT_TRUE(pooled(cube));
  EXPECT_EQ(cube.step[0], 30U * 40 * 8);
  EXPECT_EQ(cube.step[1], 40U * 8);
  EXPECT_EQ(cube.step[2], 8U);
}

TEST_F(PooledMats, LeaveTheCallersMemoryToTheCaller) {
  std::vector<unsigned char> memory(std::size_t{300} * 512, 7);
  {
    cv::Mat image(300, 500, CV_8U, memory.data(), 512);
    EXPECT_EQ(image.data, memory.data());
    EXPECT_EQ(image.step[0], 512U);
    const int sizes[] = {300, 500};
    std::size_t steps[] = {512, 1};
    cv::UMatData* data = cv::Mat::getDefaultAllocator()->allocate(
        2, sizes, CV_8U, memory.data(), steps, cv::ACCESS_RW, cv::USAGE_DEFAULT);
    EXPECT_EQ(steps[0], 512U);
    EXPECT_TRUE(data->flags & cv::UMatData::USER_ALLOCATED);
    EXPECT_EQ(data->data, memory.data());
    data->currAllocator->deallocate(data);
  }
  EXPECT_EQ(memory.back(), 7);
  EXPECT_EQ(host_.allocations(), 0);
}

TEST_F(PooledMats, AreFreedWithTheLastThatRefersToThem) {
  cv::Mat image(256, 256, CV_8U);
  const unsigned char* data = image.data;
  cv::Mat part = image(cv::Rect(0, 0, 10, 10));
  image.release();
  EXPECT_NE(cv::Mat(256, 256, CV_8U).data, data);
  part.release();
  const int allocations = host_.allocations();
  const cv::Mat one(256, 256, CV_8U), other(256, 256, CV_8U);
  EXPECT_TRUE(one.data == data || other.data == data);
  EXPECT_EQ(host_.allocations(), allocations);
}

TEST_F(PooledMats, AreOrdinaryOnesBeyondTheBound) {
  std::vector<cv::Mat> images;
  images.reserve(70);
  for (int i = 0; i < 70; ++i) images.emplace_back(1024, 1024, CV_8U, cv::Scalar(i));
  EXPECT_TRUE(pooled(images[63]));
  EXPECT_FALSE(pooled(images[64]));
  for (int i = 0; i < 70; ++i) {
    EXPECT_EQ(images[static_cast<std::size_t>(i)].at<unsigned char>(1023, 1023), i);
  }
  images.erase(images.begin());
  EXPECT_TRUE(pooled(cv::Mat(1024, 1024, CV_8U)));
}

TEST_F(PooledMats, HoldTheirContentOnManyThreads) {
  EXPECT_EQ(test::damaged_images(8, 40), 0);
  EXPECT_GT(host_.allocations(), 0);
}

TEST_F(PooledMats, HoldDecodedImages) {
  cv::Mat image(300, 400, CV_8UC3);
  cv::randu(image, 0, 256);
  std::vector<unsigned char> bytes;
  cv::imencode(".png", image, bytes);
  const cv::Mat decoded = cv::imdecode(bytes, cv::IMREAD_UNCHANGED);
  EXPECT_TRUE(pooled(decoded));
  EXPECT_EQ(cv::norm(decoded, image, cv::NORM_INF), 0);
}

TEST_F(PooledMats, CanBeSeenAsUMats) {
  cv::Mat image(300, 400, CV_8U, cv::Scalar(3));
  {
    cv::UMat seen = image.getUMat(cv::ACCESS_RW);
    seen.setTo(cv::Scalar(9));
    EXPECT_EQ(cv::countNonZero(seen.getMat(cv::ACCESS_READ) != 9), 0);
  }
  EXPECT_EQ(cv::countNonZero(image != 9), 0);
}

TEST_F(PooledMats, OutliveTheirTimeAsTheDefault) {
  cv::Mat image(300, 400, CV_8U, cv::Scalar(3));
  cv::Mat::setDefaultAllocator(cv::Mat::getStdAllocator());
  EXPECT_TRUE(pooled(image));
  image.create(400, 400, CV_8U);
  EXPECT_FALSE(pooled(image));
}

}  // namespace
}  // namespace hypotrack::cuda
