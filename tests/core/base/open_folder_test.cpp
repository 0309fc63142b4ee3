#include "base/open_folder.hpp"

#include <gmock/gmock.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "base/system_problem.hpp"
#include "expect_error.hpp"
#include "hypotrack/api/files.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class OpenFolderTest : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directory(path("a")); }
  std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }

  const test::TemporaryDirectory folder_;
};

TEST_F(OpenFolderTest, FilesFollowARenamedFolder) {
  const OpenFolder folder(path("a"));
  EXPECT_EQ(folder.place(), path("a"));
  std::filesystem::rename(path("a"), path("b"));
  std::filesystem::create_directory(path("a"));
  TextFile(folder.path() / "file").write("text");
  EXPECT_EQ(read_whole(path("b") / "file"), "text");
  EXPECT_FALSE(std::filesystem::exists(path("a") / "file"));
  EXPECT_TRUE(folder.moved());
  EXPECT_TRUE(folder.exists());
  EXPECT_EQ(folder.place(), path("b"));
}

TEST_F(OpenFolderTest, ErrorsNameTheFolderForPeople) {
  const OpenFolder folder(path("a"));
  const auto write = [&] { folder.write_with([&] { TextFile(folder.path() / "none" / "file"); }); };
  EXPECT_THAT(test::message_of<OutputError>(write), StartsWith(path("a/none/file").string()));
  std::filesystem::rename(path("a"), path("b"));
  EXPECT_THAT(test::message_of<OutputError>(write), StartsWith(path("b/none/file").string()));
}

TEST_F(OpenFolderTest, OtherDescriptorsOfATextStay) {
  const OpenFolder folder(path("a"));
  const std::string other = folder.path().string() + "0/x";
  EXPECT_EQ(folder.shown(other), other);
  EXPECT_EQ(folder.shown(folder.path().string() + ": no"), path("a").string() + ": no");
}

TEST_F(OpenFolderTest, ARemovedFolderIsAnError) {
  const OpenFolder folder(path("a"));
  std::filesystem::remove(path("a"));
  std::filesystem::create_directory(path("a"));
  EXPECT_FALSE(folder.exists());
  EXPECT_THAT(test::message_of<OutputError>(
                  [&] { folder.write_with([&] { TextFile(folder.path() / "file"); }); }),
              AllOf(StartsWith(path("a").string() + ": "), HasSubstr("was removed")));
}

TEST_F(OpenFolderTest, ErrorsOfTheSystemBecomeErrorsOfOutputs) {
  const OpenFolder folder(path("a"));
  EXPECT_THAT(
      test::message_of<OutputError>([&] {
        folder.write_with([&] { std::filesystem::create_directory(folder.path() / "no" / "b"); });
      }),
      AllOf(StartsWith(path("a/no/b").string() + ": "), HasSubstr("No such file"),
            Not(HasSubstr("filesystem error"))));
}

TEST(SystemProblem, SaysWhereWhatWhyAndWhatToDo) {
  const auto with = [](int number) { return std::make_error_code(static_cast<std::errc>(number)); };
  EXPECT_EQ(described(std::system_error(with(EAGAIN))),
            "a thread cannot be started: Resource temporarily unavailable; " + advice_on(EAGAIN));
  EXPECT_EQ(described(std::system_error(with(EMFILE), "cannot make a pipe")),
            "cannot make a pipe: Too many open files; " + advice_on(EMFILE));
  EXPECT_THAT(advice_on(EMFILE), HasSubstr("ulimit -n"));
  EXPECT_THAT(advice_on(EAGAIN), HasSubstr("ulimit -u"));
  EXPECT_EQ(with_advice("a thread: Resource temporarily unavailable"),
            "a thread: Resource temporarily unavailable; " + advice_on(EAGAIN));
  EXPECT_EQ(with_advice(described(EMFILE)), described(EMFILE));
  EXPECT_EQ(with_advice("no shortage"), "no shortage");
  EXPECT_EQ(described(std::filesystem::filesystem_error("cannot copy", "/a", "/b", with(ENOSPC))),
            "/a -> /b: cannot copy: No space left on device; " + advice_on(ENOSPC));
}

}  // namespace
}  // namespace hypotrack
