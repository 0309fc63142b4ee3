#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <regex>
#include <thread>

#include "hypotrack/api/media.hpp"
#include "served_run.hpp"

namespace hypotrack::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class LivePageTest : public ServedRun {
 protected:
  /// Reads a stream until `enough` of it is there.
  template <class Enough>
  std::string read_stream(const std::string& address, const Enough& enough) const {
    std::string text;
    client().Get(address, [&](const char* data, std::size_t size) {
      text.append(data, size);
      return !enough(text);
    });
    return text;
  }

  /// Returns a socket that is connected to the server. `buffer`: bytes that it takes unread; 0: as
  /// usual.
  int connected(int buffer = 0) const {
    const int out = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (buffer > 0) setsockopt(out, SOL_SOCKET, SO_RCVBUF, &buffer, sizeof buffer);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port()));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(connect(out, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    return out;
  }

  /// Returns the first picture of a stream.
  cv::Mat picture(const std::string& address) const {
    const std::string kEnd = "\r\n--picture\r\n";
    const std::string text = read_stream(
        address, [&](const std::string& so_far) { return so_far.find(kEnd) != std::string::npos; });
    const std::size_t begin = text.find("\r\n\r\n") + 4;
    std::string jpeg = text.substr(begin, text.find(kEnd) - begin);
    return decode_image(cv::Mat(1, static_cast<int>(jpeg.size()), CV_8UC1, jpeg.data()),
                        cv::IMREAD_COLOR);
  }
};

TEST_F(LivePageTest, ThePageAndAllItsFilesAreServed) {
  start();
  const httplib::Result page = get("/");
  ASSERT_TRUE(page);
  EXPECT_EQ(page->status, 200);
  const std::regex file("(src|href)=\"([a-z_0-9.]+)\"");
  int files = 0;
  for (std::sregex_iterator at(page->body.begin(), page->body.end(), file), end; at != end; ++at) {
    const httplib::Result answer = get("/" + (*at)[2].str());
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, 200) << (*at)[2];
    EXPECT_GT(answer->body.size(), 100u) << (*at)[2];
    ++files;
  }
  EXPECT_EQ(files, 9);
  EXPECT_EQ(get("/no_such_file")->status, 404);
  EXPECT_EQ(get("/../live_state.cpp")->status, 404);
}

TEST_F(LivePageTest, StatesOfNewFramesAreStreamed) {
  start();
  const std::string text = read_stream("/events", [](const std::string& so_far) {
    return std::count(so_far.begin(), so_far.end(), '\n') >= 6;  // two per state
  });
  std::vector<int> frames;
  for (const std::string& line : lines_of(text))
    if (line.starts_with("data: ")) {
      const auto state = nlohmann::json::parse(line.substr(6));
      frames.push_back(state["frame"]);
      EXPECT_EQ(state["models"][0]["name"], "box");
      EXPECT_EQ(state["models"][0]["motion"]["t"].size(), 3u);
      double norm = 0;
      for (const double q : state["models"][0]["motion"]["q"]) norm += q * q;
      EXPECT_NEAR(norm, 1, 1e-4);
    }
  ASSERT_GE(frames.size(), 3u);
  EXPECT_LT(frames[0], frames[1]);
  EXPECT_LT(frames[1], frames[2]);
}

TEST_F(LivePageTest, SolutionsAreStreamed) {
  start();
  const std::string text = read_stream("/solutions", [](const std::string& so_far) {
    return so_far.find("\n\n") != std::string::npos;
  });
  ASSERT_THAT(text, StartsWith("data: "));
  const auto solution = nlohmann::json::parse(lines_of(text).front().substr(6));
  EXPECT_EQ(solution["models"]["box"]["parameters"].size(), 7u);
  EXPECT_EQ(solution["models"]["box"]["landmarks"].size(), 3u);
}

TEST_F(LivePageTest, ShapesAndTheLastMinutesAreServed) {
  start();
  const auto shapes = nlohmann::json::parse(get("/scene")->body);
  EXPECT_EQ(shapes["models"][0]["name"], "box");
  EXPECT_TRUE(shapes["models"][0]["shape"].contains("vertices"));
  EXPECT_EQ(shapes["frames"], 1000000);
  const auto history = nlohmann::json::parse(get("/history")->body);
  ASSERT_GE(history["samples"].size(), 1u);
  EXPECT_EQ(history["samples"][0]["probability"].size(), 1u);
}

TEST_F(LivePageTest, PicturesHaveBothViewsBesideOrBelowEachOther) {
  start();
  EXPECT_EQ(picture("/pictures/row").size(), cv::Size(320, 120));
  EXPECT_EQ(picture("/pictures/column").size(), cv::Size(160, 240));
}

TEST_F(LivePageTest, APausedRunShowsItsFrame) {
  start();
  pause();
  EXPECT_EQ(picture("/pictures/row").size(), cv::Size(320, 120));
}

TEST_F(LivePageTest, AReaderThatNeverReadsDoesNotStopTheRun) {
  start();
  constexpr int kSmall = 4096;
  const int reader = connected(kSmall);
  const std::string request = "GET /events HTTP/1.1\r\nHost: localhost\r\n\r\n";
  ASSERT_EQ(send(reader, request.data(), request.size(), 0), static_cast<ssize_t>(request.size()));
  // More states than the buffers between server and reader hold.
  const int before = state()["frame"];
  wait_for([&](const auto& now) { return now["frame"] > before + 500; });
  EXPECT_THAT(picture("/pictures/row").size(), cv::Size(320, 120)) << "others are served";
  close(reader);
}

TEST_F(LivePageTest, AClientThatNeverEndsItsRequestDoesNotHoldUpTheEnd) {
  start();
  const int idle = connected(), slow = connected();
  const std::string request = "GET /state HTTP/1.1\r\nX: ";
  ASSERT_EQ(send(slow, request.data(), request.size(), MSG_NOSIGNAL),
            static_cast<ssize_t>(request.size()));
  program().signal(SIGINT);
  while (program().running()) {
    send(slow, "a", 1, MSG_NOSIGNAL);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  EXPECT_EQ(program().wait().exit_code, 130);
  close(idle);
  close(slow);
}

TEST_F(LivePageTest, CtrlCEndsTheStreamsAndTheRun) {
  start();
  std::string last;
  client().Get("/events", [&](const char* data, std::size_t size) {
    if (last.empty()) program().signal(SIGINT);
    last.append(data, size);
    return true;
  });
  EXPECT_THAT(last, HasSubstr("\"run\":\"ended\""));
  EXPECT_EQ(program().wait().exit_code, 130);
  EXPECT_THAT(names_in(path("out")), testing::Contains("track.csv"));
}

}  // namespace
}  // namespace hypotrack::test
