#include "served_run.hpp"

#include <chrono>
#include <csignal>
#include <regex>
#include <thread>

namespace hypotrack::test {

void ServedRun::start(const std::vector<std::string>& more,
                      const std::vector<std::string>& environment) {
  Start start;
  start.arguments = {"run",   scene(box_scene()),     "--out", path("out").string(), "--web", "0",
                     "--set", "source.frames=1000000"};
  start.arguments.insert(start.arguments.end(), more.begin(), more.end());
  start.environment = environment;
  start.err = path("err");
  program_.emplace(start);
  const std::regex address("live view: http://[^:]+:([0-9]+)/(\\?token=(.*))?\n");
  std::smatch found;
  std::string text;
  while (program_->running() && !std::regex_search(text = read_text(path("err")), found, address))
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  ASSERT_FALSE(found.empty()) << text;
  port_ = std::stoi(found[1]);
  token_ = found[3];
  wait_for([](const auto& now) { return now.contains("frame"); });
}

void ServedRun::TearDown() {
  if (!program_) return;
  if (program_->running()) program_->signal(SIGINT);
  program_->wait();
}

httplib::Client ServedRun::client() const {
  httplib::Client client("127.0.0.1", port_);
  client.set_keep_alive(false);
  // Pictures are drawn while nobody else needs the processors.
  client.set_read_timeout(std::chrono::minutes(2));
  if (!token_.empty()) client.set_bearer_token_auth(token_);
  return client;
}

httplib::Result ServedRun::get(const std::string& address, const httplib::Headers& headers) const {
  return client().Get(address, headers);
}

int ServedRun::post(const std::string& command, const httplib::Headers& headers) const {
  const httplib::Result answer = client().Post(command, headers, std::string(), "text/plain");
  return answer ? answer->status : 0;
}

nlohmann::json ServedRun::state() const {
  const httplib::Result answer = get("/state");
  return answer ? nlohmann::json::parse(answer->body) : nlohmann::json();
}

int ServedRun::pause() {
  EXPECT_EQ(post("/pause"), 204);
  return wait_for([](const auto& now) { return now["run"] == "paused"; })["frame"];
}

}  // namespace hypotrack::test
