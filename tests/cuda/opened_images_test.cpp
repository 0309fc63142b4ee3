#include <gtest/gtest.h>

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "cost/cuda/device.hpp"
#include "cost/cuda/memory/page_locked_images.hpp"
#include "session/opened_scene.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

/// What makes images once a scene is open that was evaluated with this backend.
cv::MatAllocator* allocator_of(const std::string& backend) {
  PluginLoader plugins;
  const std::vector<std::string> overrides{"evaluate.backend=" + backend};
  const OpenedScene session =
      open_scene(test::source_dir() / "configs/scenes/demo.yaml", overrides, plugins);
  return cv::Mat::getDefaultAllocator();
}

TEST(OpenedImages, AreOrdinaryOnesWhereTheSceneIsNotEvaluatedOnAGpu) {
  cv::MatAllocator* before = cv::Mat::getDefaultAllocator();
  EXPECT_EQ(allocator_of("cpu"), before);
  EXPECT_EQ(allocator_of("egl"), before);
}

TEST(OpenedImages, AreOrdinaryOnesWithoutADevice) {
  if (cuda::why_no_device().empty()) GTEST_SKIP() << "there is a GPU";
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  cuda::page_lock_images(0);
  EXPECT_EQ(allocator_of("auto"), cv::Mat::getStdAllocator());
  EXPECT_EQ(allocator_of("cuda"), cv::Mat::getStdAllocator());
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace hypotrack
