#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>

#include "hypotrack/api/files.hpp"
#include "served_run.hpp"

namespace hypotrack::test {
namespace {

using testing::HasSubstr;

/// Counts the processes of this computer whose command line has a text in it.
int count_of_command_lines_with(const std::string& text) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator("/proc"))
    count += read_whole(entry.path() / "cmdline").value_or("").find(text) != std::string::npos;
  return count;
}

class WebAccessTest : public ServedRun {
 protected:
  int status_of(const std::string& address, const httplib::Headers& headers) const {
    httplib::Client stranger("127.0.0.1", port());
    const httplib::Result answer = stranger.Get(address, headers);
    return answer ? answer->status : 0;
  }
};

TEST_F(WebAccessTest, ForeignHostsAndOriginsAreRefused) {
  start();
  EXPECT_EQ(status_of("/state", {{"Host", "localhost"}}), 200);
  for (const char* address : {"/", "/state", "/events", "/pictures/row", "/live.js"}) {
    EXPECT_EQ(status_of(address, {{"Host", "evil.example"}}), 403) << address;
    EXPECT_EQ(status_of(address, {{"Origin", "http://evil.example"}}), 403) << address;
    EXPECT_EQ(status_of(address, {{"Sec-Fetch-Site", "cross-site"}}), 403) << address;
  }
  const int frame = pause();
  EXPECT_EQ(post("/step", {{"Origin", "http://evil.example"}}), 403);
  EXPECT_EQ(post("/step", {{"Origin", fmt::format("http://127.0.0.1:{}", port())}}), 204);
  wait_for([&](const auto& now) { return now["frame"] == frame + 1; });
}

TEST_F(WebAccessTest, CommandsAreNoLinks) {
  start();
  EXPECT_EQ(status_of("/pause", {}), 404);
  EXPECT_EQ(state()["run"], "runs");
}

TEST_F(WebAccessTest, TheTokenOpensThePage) {
  start({"--web-token", "a-secret-word"});
  for (const char* address : {"/", "/state", "/events", "/pictures/row"})
    EXPECT_EQ(status_of(address, {}), 403) << address;
  EXPECT_EQ(status_of("/?token=another-word", {}), 403);
  EXPECT_EQ(status_of("/state", {{"Authorization", "Bearer a-secret-word"}}), 200);
  httplib::Client browser("127.0.0.1", port());
  const httplib::Result page = browser.Get("/?token=a-secret-word");
  ASSERT_TRUE(page);
  ASSERT_EQ(page->status, 200);
  const std::string cookie = page->get_header_value("Set-Cookie");
  EXPECT_THAT(cookie, testing::AllOf(HasSubstr("HttpOnly"), HasSubstr("SameSite=Strict")));
  EXPECT_EQ(status_of("/state", {{"Cookie", "a=b; " + cookie.substr(0, cookie.find(';'))}}), 200);
}

TEST_F(WebAccessTest, TheTokenOpensThePageByAnyName) {
  start({"--web-token", "a-secret-word", "--web-host", "0.0.0.0"});
  for (const char* host : {"station.local", "station.lab.example:8080", "container-host"}) {
    EXPECT_EQ(status_of("/?token=a-secret-word", {{"Host", host}}), 200) << host;
    EXPECT_EQ(status_of("/", {{"Host", host}}), 403) << host;
  }
  EXPECT_EQ(post("/pause", {{"Host", "hands.example"}, {"Origin", "https://Hands.example"}}), 204);
  EXPECT_EQ(post("/resume", {{"Host", "hands.example"}, {"Origin", "https://evil.example"}}), 403);
}

TEST_F(WebAccessTest, RefusedNamesAreToldTheOptionThatAllowsThem) {
  start();
  const httplib::Result answer = get("/", {{"Host", "station.local"}});
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 403);
  EXPECT_THAT(answer->body, HasSubstr("--web-token-file FILE"));
}

TEST_F(WebAccessTest, OtherHostsThanLoopbackNeedAToken) {
  expect_refused(box_scene(), {"--web-host 0.0.0.0", "--web-token-file FILE"},
                 {"--web", "0", "--web-host", "0.0.0.0"});
}

TEST_F(WebAccessTest, TheTokenMayComeFromAFile) {
  write_text(path("word"), "a-word-in-a-file\n");
  std::filesystem::permissions(path("word"), std::filesystem::perms::owner_read);
  start({"--web-token-file", path("word").string()});
  EXPECT_EQ(token(), "a-word-in-a-file");
  EXPECT_EQ(status_of("/state", {}), 403);
  EXPECT_THAT(read_text(path("err")), testing::Not(HasSubstr("note: --web-token-file")));
}

TEST_F(WebAccessTest, TheTokenMayComeFromTheEnvironment) {
  start({}, {"HYPOTRACK_WEB_TOKEN=a-word-in-a-variable"});
  EXPECT_EQ(token(), "a-word-in-a-variable");
  EXPECT_EQ(status_of("/state", {}), 403);
}

TEST_F(WebAccessTest, TwoTokensAreRefused) {
  expect_refused(box_scene(), {"--web-token and --web-token-file", "leave all but one out"},
                 {"--web", "0", "--web-token", "a-secret-word", "--web-token-file", "word"});
}

TEST_F(WebAccessTest, ListsOfProcessesDoNotShowTheToken) {
  const std::string word = fmt::format("a-word-{}-of-this-test", getpid());
  for (const std::vector<std::string>& options :
       {std::vector<std::string>{"--web-token", word}, {"--web-token=" + word}}) {
    start(options);
    EXPECT_EQ(token(), word);
    EXPECT_EQ(count_of_command_lines_with(path("scene.yaml").string()), 1);
    EXPECT_EQ(count_of_command_lines_with(word), 0);
    TearDown();
  }
}

TEST_F(WebAccessTest, RulesWithoutAPageAreRefused) {
  expect_refused(box_scene(), {"give --web PORT"}, {"--web-token", "a-secret-word"});
}

TEST_F(WebAccessTest, APortInUseIsRefused) {
  start();
  const std::string used = std::to_string(port());
  const Outcome outcome = run_program(
      {"run", path("scene.yaml").string(), "--out", path("second").string(), "--web", used});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_EQ(lines_of(outcome.err).size(), 1u) << outcome.err;
  EXPECT_THAT(outcome.err,
              testing::AllOf(HasSubstr("port " + used), HasSubstr("Address already in use"),
                             HasSubstr("give another port, or 0")));
  EXPECT_FALSE(std::filesystem::exists(path("second")));
}

}  // namespace
}  // namespace hypotrack::test
