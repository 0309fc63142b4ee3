#include "base/standard_streams.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <initializer_list>
#include <vector>

namespace hypotrack {
namespace {

/// Returns whether a descriptor is /dev/null, open for what its number is for.
bool is_null_device(int number) {
  struct stat found {};
  struct stat null {};
  if (fstat(number, &found) != 0 || stat("/dev/null", &null) != 0) return false;
  const int expected = number == STDIN_FILENO ? O_RDONLY : O_WRONLY;
  return found.st_rdev == null.st_rdev && (fcntl(number, F_GETFL) & O_ACCMODE) == expected;
}

/// Closes some of three open streams, opens the standard ones and ends the process with the sum of
/// 1 << number over those that are /dev/null. 100: the next file to be opened gets one of their
/// numbers.
[[noreturn]] void close_and_open(const std::vector<int>& closed) {
  std::array<int, 2> pipe_ends{};
  if (pipe(pipe_ends.data()) != 0) std::_Exit(101);
  for (const int number : {0, 1, 2}) dup2(pipe_ends[0], number);
  for (const int number : closed) close(number);
  open_standard_streams();
  int null = 0;
  for (const int number : {0, 1, 2})
    if (is_null_device(number)) null += 1 << number;
  std::_Exit(open("/dev/zero", O_RDONLY) > STDERR_FILENO ? null : 100);
}

TEST(StandardStreamsDeathTest, ClosedOnesAreTheNullDeviceAndOpenOnesStay) {
  EXPECT_EXIT(close_and_open({}), testing::ExitedWithCode(0), "");
  EXPECT_EXIT(close_and_open({0}), testing::ExitedWithCode(1), "");
  EXPECT_EXIT(close_and_open({1}), testing::ExitedWithCode(2), "");
  EXPECT_EXIT(close_and_open({1, 2}), testing::ExitedWithCode(6), "");
  EXPECT_EXIT(close_and_open({0, 1, 2}), testing::ExitedWithCode(7), "");
}

}  // namespace
}  // namespace hypotrack
