#include <fmt/format.h>

#include "served_run.hpp"

namespace hypotrack::test {
namespace {

using testing::HasSubstr;

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

TEST_F(WebAccessTest, OtherHostsThanLoopbackNeedAToken) {
  expect_refused(box_scene(), {"--web-host 0.0.0.0", "--web-token WORD"},
                 {"--web", "0", "--web-host", "0.0.0.0"});
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
