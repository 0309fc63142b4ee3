#include "running/web_token.hpp"

#include <sys/stat.h>

#include <cstdlib>

#include "app_test.hpp"
#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack::test {
namespace {

using app::read_web_token;
using app::WebTokenSources;
using testing::AllOf;
using testing::HasSubstr;

class WebTokenTest : public AppTest {
 protected:
  std::filesystem::path file(const std::string& text, mode_t mode = 0600) const {
    write_text(path("word"), text);
    chmod(path("word").c_str(), mode);
    return path("word");
  }
  std::string word_of(const WebTokenSources& sources) {
    return read_web_token(sources, [this](const std::string& text) { notes_ += text; }).word;
  }
  std::string refusal_of(const WebTokenSources& sources) {
    return message_of<ConfigError>([&] { word_of(sources); });
  }

  std::string notes_;
};

TEST_F(WebTokenTest, IsTheWordOfTheOneSourceThatIsGiven) {
  EXPECT_EQ(word_of({}), "");
  EXPECT_EQ(word_of({.word = "a-secret-word"}), "a-secret-word");
  EXPECT_EQ(word_of({.variable = "a-secret-word"}), "a-secret-word");
  for (const char* text : {"a-secret-word", "a-secret-word\n", "a-secret-word\r\n"})
    EXPECT_EQ(word_of({.file = file(text)}), "a-secret-word");
  EXPECT_EQ(notes_, "");
}

TEST_F(WebTokenTest, SourcesAreNamedAsTheUserGaveThem) {
  const auto ignore = [](const std::string&) {};
  EXPECT_EQ(read_web_token({.word = "a"}, ignore).source, "--web-token");
  EXPECT_EQ(read_web_token({.variable = "a"}, ignore).source, "HYPOTRACK_WEB_TOKEN");
  EXPECT_EQ(read_web_token({.file = file("a")}, ignore).source,
            "--web-token-file " + path("word").string());
}

TEST_F(WebTokenTest, SeveralSourcesAreRefused) {
  EXPECT_THAT(refusal_of({.word = "a", .variable = "b"}),
              AllOf(HasSubstr("--web-token and HYPOTRACK_WEB_TOKEN"), HasSubstr("leave all but")));
  EXPECT_THAT(refusal_of({.word = "a", .file = file("b"), .variable = "c"}),
              HasSubstr("--web-token and --web-token-file and HYPOTRACK_WEB_TOKEN"));
}

TEST_F(WebTokenTest, FilesThatHoldNoWordAreRefused) {
  EXPECT_THAT(refusal_of({.file = path("none")}),
              AllOf(HasSubstr("none: cannot be read: No such file"), HasSubstr("openssl rand")));
  EXPECT_THAT(refusal_of({.file = folder()}), HasSubstr("Is a directory"));
  EXPECT_THAT(refusal_of({.file = file("\n")}), HasSubstr("word: is empty"));
  EXPECT_THAT(refusal_of({.file = "/dev/zero"}), HasSubstr("has more than 4096 bytes"));
  EXPECT_THAT(refusal_of({.variable = ""}), HasSubstr("HYPOTRACK_WEB_TOKEN: is empty"));
}

TEST_F(WebTokenTest, AFileThatOthersMayReadIsNoted) {
  EXPECT_EQ(word_of({.file = file("a-secret-word", 0644)}), "a-secret-word");
  EXPECT_THAT(notes_, AllOf(HasSubstr("every user of this computer may read"),
                            HasSubstr("chmod go= " + path("word").string())));
}

TEST_F(WebTokenTest, StartedProgramsDoNotGetTheVariable) {
  setenv("HYPOTRACK_WEB_TOKEN", "a-secret-word", 1);
  EXPECT_EQ(app::take_web_token_variable(), "a-secret-word");
  EXPECT_EQ(app::take_web_token_variable(), std::nullopt);
  EXPECT_EQ(capture_output({"/bin/sh", {"-c", "echo \"<$HYPOTRACK_WEB_TOKEN>\""}}, {1}).output,
            "<>\n");
}

}  // namespace
}  // namespace hypotrack::test
