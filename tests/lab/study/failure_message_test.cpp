#include "run/crew/crew.hpp"
#include "study_test.hpp"

namespace hypotrack::test {
namespace {

class FailureMessageTest : public StudyTest {
 protected:
  std::string message(const std::string& log, const Ended& ended) const {
    write("log.txt", log);
    return failure_message(path("log.txt"), ended);
  }
};

constexpr Ended kCode1{.end = {.code = 1}};
constexpr Ended kCode66{.end = {.code = 66}};
constexpr Ended kAborted{.end = {.code = 134, .signal = 6}};

TEST_F(FailureMessageTest, IsHypotracksLastMessageWithItsFurtherLines) {
  EXPECT_EQ(
      message("hypotrack: first\nframe 3\nhypotrack: a.yaml:\n  no such file\nother\n", kCode1),
      "a.yaml: no such file");
}

TEST_F(FailureMessageTest, OfAProgramWithoutAMessageEndsWithTheLastLineInWords) {
  EXPECT_EQ(message("frame 3\n  SUMMARY: data race\n=====\n\n", kCode66),
            "ended with exit code 66; its last line: SUMMARY: data race");
  EXPECT_EQ(message("free(): invalid pointer\n", kAborted),
            "ended by signal 6 (Aborted); its last line: free(): invalid pointer");
}

TEST_F(FailureMessageTest, NamesTheSignalAfterHypotracksMessage) {
  EXPECT_EQ(message("hypotrack: frame 0: optimizer 'x'\n", kAborted),
            "frame 0: optimizer 'x'; ended by signal 6 (Aborted)");
}

TEST_F(FailureMessageTest, OfAnEmptyOrMissingLogIsTheEndAlone) {
  EXPECT_EQ(message("", kCode66), "ended with exit code 66");
  EXPECT_EQ(failure_message(path("no_such_log.txt"), kCode66), "ended with exit code 66");
}

TEST_F(FailureMessageTest, ShowsTheBeginningOfALongLine) {
  EXPECT_EQ(message(std::string(10'000, 'a') + "\n", kCode66),
            "ended with exit code 66; its last line: " + std::string(200, 'a'));
}

TEST_F(FailureMessageTest, SaysThatSuccessCameTooEarly) {
  EXPECT_EQ(message("", Ended{}), "ended with exit code 0 before its results were complete");
}

}  // namespace
}  // namespace hypotrack::test
