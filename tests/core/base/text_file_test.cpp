#include "base/text_file.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <iterator>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "test_paths.hpp"

namespace hypotrack::test {
namespace {

using testing::HasSubstr;

class WriteWholeTest : public testing::Test {
 protected:
  std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }

  std::string read(const std::string& name) const {
    std::ifstream in(path(name));
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  }

  TemporaryDirectory folder_;
};

TEST_F(WriteWholeTest, ReplacesAFileAndLeavesNothingElse) {
  write_whole(path("a.txt"), "first");
  write_whole(path("a.txt"), "second");
  EXPECT_EQ(read("a.txt"), "second");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 1);
}

TEST_F(WriteWholeTest, WritesTheFileThatALinkNames) {
  write_whole(path("a.txt"), "first");
  std::filesystem::create_symlink("a.txt", path("link"));
  write_whole(path("link"), "second");
  EXPECT_TRUE(std::filesystem::is_symlink(path("link")));
  EXPECT_EQ(read("a.txt"), "second");
}

TEST_F(WriteWholeTest, WritesIntoAPipe) {
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  const int reader = ::open(path("pipe").c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_GE(reader, 0);
  write_whole(path("pipe"), "text");
  char text[8] = {};
  EXPECT_EQ(::read(reader, text, sizeof text), 4);
  EXPECT_STREQ(text, "text");
  ::close(reader);
  EXPECT_TRUE(std::filesystem::is_fifo(path("pipe")));
}

TEST_F(WriteWholeTest, RefusesAPipeThatNobodyReads) {
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  EXPECT_THAT(message_of<OutputError>([&] { write_whole(path("pipe"), "text"); }),
              HasSubstr("pipe: cannot be written"));
}

TEST_F(WriteWholeTest, LeavesADeviceADevice) {
  std::filesystem::create_symlink("/dev/null", path("null"));
  write_whole(path("null"), "text");
  EXPECT_TRUE(std::filesystem::is_symlink(path("null")));
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

class ReadWholeTest : public WriteWholeTest {};

TEST_F(ReadWholeTest, ReadsBytesOfEveryKindToTheEnd) {
  std::string bytes(100'003, '\0');  // larger than any buffer on the way
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i * 31 % 256);
  write_whole(path("bytes"), bytes);
  EXPECT_EQ(read_whole(path("bytes")), bytes);
}

TEST_F(ReadWholeTest, ReadsAnEmptyFileAndOneWithoutSize) {
  write_whole(path("empty"), "");
  EXPECT_EQ(read_whole(path("empty")), "");
  EXPECT_THAT(read_whole("/proc/self/status").value_or(""), HasSubstr("VmRSS"));
}

TEST_F(ReadWholeTest, ReturnsNothingForWhatCannotBeRead) {
  EXPECT_EQ(read_whole(path("absent")), std::nullopt);
  EXPECT_EQ(read_whole(folder_.path()), std::nullopt);
}

}  // namespace
}  // namespace hypotrack::test
