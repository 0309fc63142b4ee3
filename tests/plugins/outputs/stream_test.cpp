#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "expect_error.hpp"
#include "hypotrack/api/session.hpp"
#include "hypotrack/api/solution.hpp"
#include "line_server.hpp"
#include "output_run.hpp"
#include "stream_reader.hpp"
#include "test_models.hpp"

namespace hypotrack {
namespace {

using nlohmann::json;
using test::message_of;
using ::testing::AllOf;
using ::testing::HasSubstr;
using TcpEndpoint = boost::asio::ip::tcp::endpoint;

class StreamTest : public ::testing::Test {
 protected:
  std::filesystem::path socket_file() const { return folder_.path() / "socket"; }
  std::string at_socket(const std::string& more = "") const {
    return "{type: stream, socket: " + socket_file().string() + more + "}";
  }
  std::unique_ptr<Output> begun(const std::string& yaml) {
    std::unique_ptr<Output> output = run_.open(yaml);
    output->begin(run_);
    return output;
  }
  std::string message(const std::string& yaml) {
    return message_of<OutputError>([&] { begun(yaml); });
  }
  std::string refused(const std::string& yaml) {
    return message_of<ConfigError>([&] { run_.open(yaml); });
  }
  /// Connects and reads the first line.
  test::LocalReader connected() const {
    test::LocalReader reader = test::read_socket(socket_file());
    EXPECT_EQ(reader.json()["stream"], "hypotrack");
    return reader;
  }

  const Scene scene_{{{"hand", std::make_shared<Model>(test::make_test_hand())},
                      {"box", std::make_shared<Model>(test::make_test_box())}}};
  test::OutputRun run_{scene_};
  const test::TemporaryDirectory folder_;
};

/// Returns a port of this machine that is free.
int free_port() {
  using boost::asio::ip::tcp;
  boost::asio::io_context io;
  return tcp::acceptor(io, {boost::asio::ip::address_v4::loopback(), 0}).local_endpoint().port();
}

TEST_F(StreamTest, EveryReaderGetsTheLinesOfJsonlUntilTheRunEnds) {
  const auto output = begun(at_socket());
  test::LocalReader first = connected(), second = connected();
  const std::vector<Solution> solutions = test::random_solutions(scene_, 5);
  for (const Solution& solution : solutions) output->online({}, solution);
  output->finish(true);
  for (test::LocalReader* reader : {&first, &second}) {
    for (const Solution& solution : solutions)
      EXPECT_EQ(reader->line(), solution_json(scene_, solution));
    EXPECT_EQ(reader->line(), std::nullopt);
  }
  EXPECT_FALSE(std::filesystem::exists(socket_file()));
}

TEST_F(StreamTest, TheEndLeavesTheSocketOfAnotherRun) {
  const auto first = begun(at_socket());
  std::filesystem::rename(socket_file(), folder_.path() / "moved");
  const auto second = begun(at_socket());
  first->finish(true);
  const test::LocalReader reader = connected();
  second->finish(true);
  EXPECT_FALSE(std::filesystem::exists(socket_file()));
}

TEST_F(StreamTest, APortIsThatOfThisMachineOnly) {
  const int port = free_port();
  const auto output = begun("{type: stream, port: " + std::to_string(port) + "}");
  const auto number = static_cast<std::uint16_t>(port);
  test::TcpReader reader(TcpEndpoint(boost::asio::ip::address_v4::loopback(), number));
  EXPECT_EQ(reader.json()["stream"], "hypotrack");
  output->online({}, test::random_solutions(scene_, 1).front());
  EXPECT_EQ(reader.json()["frame"], 0);
  const std::string everyone = "{type: stream, host: 0.0.0.0, port: " + std::to_string(port) + "}";
  EXPECT_THAT(message(everyone),
              AllOf(HasSubstr("cannot listen at port " + std::to_string(port) + " of 0.0.0.0"),
                    HasSubstr("Address already in use"), HasSubstr("give another port")));
}

TEST_F(StreamTest, TheFirstLineNamesWhatTheOthersHave) {
  const auto output = begun(at_socket());
  test::LocalReader reader = test::read_socket(socket_file());
  const json greeting = reader.json();
  output->online({}, test::random_solutions(scene_, 1).front());
  const json line = reader.json();
  for (const auto& [name, model] : line["models"].items()) {
    const json& described = greeting["models"][name];
    for (const auto& [parameter, value] : model["parameters"].items())
      EXPECT_TRUE(described["parameters"].contains(parameter)) << parameter;
    std::set<std::string> landmarks;
    for (const auto& [landmark, value] : model["landmarks"].items()) landmarks.insert(landmark);
    EXPECT_EQ(described["landmarks"].get<std::set<std::string>>(), landmarks);
  }
  EXPECT_EQ(greeting["models"]["box"]["parameters"]["position_x"], "m");
  EXPECT_EQ(greeting["models"]["box"]["parameters"]["rotation_w"], "1");
  const json& camera = greeting["cameras"][1];
  EXPECT_EQ(camera["width"], 640);
  EXPECT_EQ(camera["distortion_model"], "brown");
  EXPECT_EQ(camera["camera_from_world"][0][3], -0.1);
  EXPECT_EQ(camera["camera_from_world"][3], json({0, 0, 0, 1}));
  EXPECT_EQ(greeting["frame_rate"], 30);
}

TEST_F(StreamTest, OnlyFramesOfALiveSourceHaveAnAge) {
  const auto output = begun(at_socket());
  test::LocalReader reader = connected();
  const std::vector<Solution> solutions = test::random_solutions(scene_, 2);
  Frame live;
  live.taken = std::chrono::steady_clock::now() - std::chrono::seconds(20);
  output->online(live, solutions[0]);
  output->online({}, solutions[1]);
  json line = reader.json();
  EXPECT_GE(line["age"], 20);
  line.erase("age");
  EXPECT_EQ(line, json::parse(solution_json(scene_, solutions[0])));
  EXPECT_FALSE(reader.json().contains("age"));
}

TEST_F(StreamTest, SmoothedSolutionsAreSentWhereAsked) {
  const auto output = begun(at_socket(", online: false"));
  test::LocalReader reader = connected();
  const std::vector<Solution> solutions = test::random_solutions(scene_, 2);
  output->online({}, solutions[0]);
  output->frame({}, solutions[1]);
  EXPECT_EQ(reader.json()["frame"], 1);
}

TEST_F(StreamTest, ASlowReaderLosesTheOldestLinesAndIsToldHowMany) {
  constexpr int kFrames = 400;  // 2 MB, more than what the kernel's queue takes
  const auto output = begun(at_socket(", queue: 8"));
  test::LocalReader slow = connected(), quick = connected();
  Solution solution = test::random_solutions(scene_, 1).front();
  for (solution.frame = 0; solution.frame < kFrames; ++solution.frame) {
    output->online({}, solution);
    EXPECT_EQ(quick.json()["frame"], solution.frame);
  }
  int last = -1, dropped = 0;
  while (last < kFrames - 1) {
    const json line = slow.json();
    ASSERT_FALSE(line.is_null());
    const int missing = line.value("dropped", 0);
    EXPECT_EQ(line["frame"], last + 1 + missing);
    last = line["frame"];
    dropped += missing;
  }
  EXPECT_GT(dropped, 0);
}

TEST_F(StreamTest, AReaderThatLeavesDisturbsNobody) {
  const auto output = begun(at_socket());
  test::LocalReader leaves = connected(), stays = connected();
  leaves.close();
  for (const Solution& solution : test::random_solutions(scene_, 5)) {
    output->online({}, solution);
    EXPECT_EQ(stays.json()["frame"], solution.frame);
  }
}

TEST_F(StreamTest, AReaderThatSendsNoMoreReadsOn) {
  const auto output = begun(at_socket());
  test::LocalReader silent = connected();
  silent.end_sending();
  for (const Solution& solution : test::random_solutions(scene_, 5)) {
    output->online({}, solution);
    EXPECT_EQ(silent.json()["frame"], solution.frame);
  }
}

TEST_F(StreamTest, AReaderThatHangsIsDropped) {
  const stream::Address address{socket_file(), "", 0};
  stream::LineServer server(address, R"({"stream":"hypotrack"})",
                            {.lines = 2, .hangs = std::chrono::milliseconds(20)});
  test::LocalReader hangs = connected();
  constexpr std::size_t kMuch = 1 << 20;  // more than what the kernel's queue takes
  server.send("{\"" + std::string(kMuch, 'a') + "\":1}");
  hangs.wait_for_end();
  test::LocalReader another = connected();
  server.send("{}");
  EXPECT_EQ(another.line(), "{}");
}

TEST_F(StreamTest, AReaderThatHangsDoesNotHoldUpTheEnd) {
  const auto output = begun(at_socket());
  const test::LocalReader hangs = connected();
  Solution solution = test::random_solutions(scene_, 1).front();
  for (solution.frame = 0; solution.frame < 300; ++solution.frame) output->online({}, solution);
  output->finish(false);
  EXPECT_FALSE(std::filesystem::exists(socket_file()));
}

TEST_F(StreamTest, TooManyReadersAreToldSo) {
  const auto output = begun(at_socket());
  std::vector<test::LocalReader> readers;
  for (int i = 0; i < 32; ++i) readers.push_back(connected());
  test::LocalReader one_more = test::read_socket(socket_file());
  EXPECT_EQ(one_more.json()["error"], "32 readers are connected, which is the limit");
  EXPECT_EQ(one_more.line(), std::nullopt);
}

TEST_F(StreamTest, TheSocketOfACrashedRunIsReplaced) {
  {
    boost::asio::io_context io;
    boost::asio::local::stream_protocol::acceptor crashed(io, socket_file().string());
  }
  ASSERT_TRUE(std::filesystem::is_socket(socket_file()));
  const auto output = begun(at_socket());
  EXPECT_TRUE(connected().connected());
}

TEST_F(StreamTest, WhatElseIsAtTheSocketsPathStays) {
  std::ofstream(socket_file()) << "a table";
  EXPECT_THAT(message(at_socket()),
              AllOf(HasSubstr(socket_file().string() + " is there already and is no socket"),
                    HasSubstr("Name another file")));
  EXPECT_EQ(std::filesystem::file_size(socket_file()), 7U);
}

TEST_F(StreamTest, ASocketWhereARunListensIsRefused) {
  const auto output = begun(at_socket());
  EXPECT_THAT(message(at_socket()), HasSubstr("listens at " + socket_file().string()));
  EXPECT_TRUE(connected().connected());
}

TEST_F(StreamTest, AddressesThatCannotBeAreRefused) {
  const std::string missing = folder_.path().string() + "/none/socket";
  EXPECT_THAT(message("{type: stream, socket: " + missing + "}"),
              AllOf(HasSubstr("cannot listen at " + missing), HasSubstr("No such file")));
  EXPECT_THAT(message("{type: stream, port: 5005, host: no host}"),
              HasSubstr("the host no host is not known"));
  EXPECT_THAT(message("{type: stream, port: 5005, host: 192.0.2.1}"),
              AllOf(HasSubstr("cannot listen at port 5005 of 192.0.2.1"),
                    HasSubstr("expected an address of this machine")));
}

TEST_F(StreamTest, ParametersThatGiveNoAddressAreRefused) {
  EXPECT_THAT(refused("type: stream"), HasSubstr("no port and no socket; expected one of"));
  EXPECT_THAT(refused(at_socket(", port: 5005")), HasSubstr("a port and a socket"));
  EXPECT_THAT(refused(at_socket(", host: 0.0.0.0")), HasSubstr("a socket file is of this machine"));
  const std::string longest = "/tmp/" + std::string(102, 'a');
  run_.open("{type: stream, socket: " + longest + "}");
  EXPECT_THAT(refused("{type: stream, socket: " + longest + "a}"),
              AllOf(HasSubstr("has 108 bytes; expected at most 107"), HasSubstr("scene.yaml")));
}

TEST_F(StreamTest, ARunThatCannotListenEndsBeforeItTracks) {
  std::ofstream(socket_file()) << "a table";
  const auto scene = folder_.path() / "scene.yaml", out = folder_.path() / "out";
  std::ofstream(scene) << R"(models:
  - {name: box, type: rigid_box, size_mm: [60, 90, 40]}
source:
  type: synthetic
  frames: 2
  cameras: {width: 160, height: 120, focal_px: 150, baseline_mm: 100}
  keyframes:
    - {frame: 0, pose: {box: {position_mm: [0, 0, 400]}}}
objective: {type: stereo_color}
optimizer: {type: pso, particles: 16, generations: 8}
init: {from: truth}
output:
  overlay: false
  also: {type: stream, socket: socket}
)";
  struct : RunWatcher {
    void frame(const Frame&, const Solution&, double) override { ++frames; }
    int frames = 0;
  } watcher;
  EXPECT_THAT(
      message_of<OutputError>([&] { Session(scene).run({.out = out, .frames = {}}, watcher); }),
      AllOf(HasSubstr("scene.yaml:14:9: "), HasSubstr("is no socket")));
  EXPECT_EQ(watcher.frames, 0);
  EXPECT_FALSE(std::filesystem::exists(out));
}

}  // namespace
}  // namespace hypotrack
