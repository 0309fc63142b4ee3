#include "cost/cuda/memory/page_locked_images.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "device.hpp"
#include "hypotrack/gpu/runtime.cuh"
#include "image_work.hpp"
#include "session/opened_scene.hpp"
#include "test_paths.hpp"

namespace hypotrack::cuda {
namespace {

bool page_locked(const void* at) {
  cudaPointerAttributes attributes{};
  check(cudaPointerGetAttributes(&attributes, at), "asking for what memory it is");
  return attributes.type == cudaMemoryTypeHost;
}

bool page_locked(const cv::Mat& image) {
  return page_locked(image.datastart) && page_locked(image.dataend - 1);
}

/// The first frame's first image of a scene that is evaluated with this backend.
cv::Mat first_image(const std::string& backend) {
  PluginLoader plugins;
  const std::vector<std::string> overrides{"evaluate.backend=" + backend, "optimizer={type: pso}"};
  const OpenedScene session =
      open_scene(test::source_dir() / "configs/scenes/demo.yaml", overrides, plugins);
  return session.source->next().value().views.at(0).color;
}

TEST(PageLockedImages, AreThoseOfASceneOnTheGpu) {
  SKIP_WITHOUT_DEVICE();
  EXPECT_TRUE(page_locked(first_image("cuda")));
  EXPECT_TRUE(page_locked(first_image("auto")));
}

TEST(PageLockedImages, AreThoseOf64KiBAndMore) {
  SKIP_WITHOUT_DEVICE();
  page_lock_images(0);
  EXPECT_TRUE(page_locked(cv::Mat(256, 256, CV_8U)));
  EXPECT_FALSE(page_locked(cv::Mat(256, 255, CV_8U)));
  EXPECT_TRUE(page_locked(cv::Mat(720, 1280, CV_8UC3)));
  EXPECT_TRUE(page_locked(cv::Mat(720, 1280, CV_32F).clone()));
}

TEST(PageLockedImages, AreMadeByOneAllocator) {
  SKIP_WITHOUT_DEVICE();
  page_lock_images(0);
  cv::MatAllocator* installed = cv::Mat::getDefaultAllocator();
  EXPECT_NE(installed, cv::Mat::getStdAllocator());
  page_lock_images(0);
  EXPECT_EQ(cv::Mat::getDefaultAllocator(), installed);
}

TEST(PageLockedImages, HoldTheirContentOnManyThreads) {
  SKIP_WITHOUT_DEVICE();
  page_lock_images(0);
  EXPECT_EQ(test::damaged_images(8, 40), 0);
}

TEST(PageLockedImages, LieWhereOthersLay) {
  SKIP_WITHOUT_DEVICE();
  page_lock_images(0);
  cv::Mat image(700, 900, CV_8UC3);
  const unsigned char* before = image.data;
  image.release();
  EXPECT_EQ(cv::Mat(700, 900, CV_8UC3).data, before);
}

TEST(PageLockedImages, AreWhatFilesAreDecodedInto) {
  SKIP_WITHOUT_DEVICE();
  page_lock_images(0);
  cv::Mat image(300, 400, CV_8UC3);
  cv::randu(image, 0, 256);
  std::vector<unsigned char> bytes;
  cv::imencode(".png", image, bytes);
  const cv::Mat decoded = cv::imdecode(bytes, cv::IMREAD_COLOR);
  EXPECT_TRUE(page_locked(decoded));
  EXPECT_EQ(cv::norm(decoded, image, cv::NORM_INF), 0);
}

TEST(PageLockedImages, CanBeMadeWhileAGraphIsCaptured) {
  SKIP_WITHOUT_DEVICE();
  page_lock_images(0);
  cudaStream_t stream = nullptr;
  check(cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking), "making a stream");
  for (const auto mode : {cudaStreamCaptureModeThreadLocal, cudaStreamCaptureModeGlobal}) {
    check(cudaStreamBeginCapture(stream, mode), "beginning a graph");
    const cv::Mat image(3000 + 2000 * static_cast<int>(mode), 2000, CV_8U);  // of a new size
    cudaGraph_t graph = nullptr;
    EXPECT_EQ(cudaStreamEndCapture(stream, &graph), cudaSuccess);
    EXPECT_TRUE(page_locked(image));
    if (graph) check(cudaGraphDestroy(graph), "freeing a graph");
  }
  check(cudaStreamDestroy(stream), "freeing a stream");
}

// The last one: it leaves no room for images of other sizes.
TEST(PageLockedImages, AreOrdinaryOnesBeyondTheBound) {
  SKIP_WITHOUT_DEVICE();
  page_lock_images(0);
  std::vector<cv::Mat> images;
  for (int i = 0; i < 9; ++i) images.emplace_back(1 << 14, 1 << 13, CV_8U);  // 128 MiB each
  EXPECT_TRUE(page_locked(images.front()));
  EXPECT_FALSE(page_locked(images.back()));
  images.back().setTo(cv::Scalar(5));
  EXPECT_EQ(cv::countNonZero(images.back() != 5), 0);
}

}  // namespace
}  // namespace hypotrack::cuda
