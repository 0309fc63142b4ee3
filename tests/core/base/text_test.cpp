#include "hypotrack/api/text.hpp"

#include <gtest/gtest.h>

namespace hypotrack {
namespace {

TEST(Text, IsTrimmedOfBlanksOrOfWhatIsGiven) {
  EXPECT_EQ(trimmed(" \t a b\r\n"), "a b");
  EXPECT_EQ(trimmed(" \n"), "");
  EXPECT_EQ(trimmed(""), "");
  EXPECT_EQ(trimmed("# a #", "# "), "a");
}

TEST(Text, ForMessagesHasNoControlCharactersAndIsCutBetweenCharacters) {
  EXPECT_EQ(printable("a\x1B[2J\tb\x7F"), "a?[2J?b?");
  EXPECT_EQ(printable("abc", 3), "abc");
  EXPECT_EQ(printable("abcd", 3), "abc...");
  EXPECT_EQ(printable("a\xC3\xA4\xC3\xA4", 4), "a\xC3\xA4...");
  EXPECT_EQ(printable("\xC3\xA4", 1), "...");
  EXPECT_EQ(printable(std::string(100, 'x')).size(), 63);
}

}  // namespace
}  // namespace hypotrack
