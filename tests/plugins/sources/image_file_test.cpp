#include "hypotrack/image_file.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "test_paths.hpp"

namespace hypotrack {
namespace {

/// Leaves this process so many bytes of address space beside what it has.
void leave_memory(rlim_t bytes) {
  rlim_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const rlim_t most = pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + bytes;
  const rlimit limit{most, most};
  setrlimit(RLIMIT_AS, &limit);
}

TEST(ImageFileDeathTest, LackOfMemoryIsNotCalledDamage) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers reserve the address space that this test limits";
#endif
  const test::TemporaryDirectory folder;
  const auto file = folder.path() / "large.png";
  ASSERT_TRUE(cv::imwrite(file.string(), cv::Mat::zeros(6000, 8000, CV_8U)));
  EXPECT_EQ(read_color(file).problem, "");
  const auto read_with_little = [&] {
    leave_memory(rlim_t{16} << 20);
    std::fputs(read_color(file).problem.c_str(), stderr);
    std::exit(0);
  };
  EXPECT_EXIT(read_with_little(), testing::ExitedWithCode(0),
              "large.png: there is not enough memory to decode it");
}

}  // namespace
}  // namespace hypotrack
