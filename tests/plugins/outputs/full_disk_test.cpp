#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "expect_error.hpp"
#include "output_run.hpp"
#include "test_models.hpp"

namespace hypotrack {
namespace {

TEST(FullDisk, OutputsNameTheFileAndTheReason) {
  const auto scene = test::make_scene({{"hand", "type: hand"}});
  test::OutputRun run(*scene);
  run.full_disk = true;
  for (const std::string type : {"jsonl", "tum", "bvh", "gltf", "keypoints"})
    EXPECT_THAT(test::message_of<OutputError>(
                    [&] { run.play("type: " + type, test::random_solutions(*scene, 2)); }),
                ::testing::HasSubstr("/dev/full: cannot be written: No space left on device"))
        << type;
}

}  // namespace
}  // namespace hypotrack
