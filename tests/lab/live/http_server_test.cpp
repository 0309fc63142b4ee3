#include "lab/live/http_server.hpp"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <latch>
#include <string>
#include <thread>

#include "lab/live/connection.hpp"
#include "lab/live/request_queue.hpp"

namespace hypotrack {
namespace {

using testing::EndsWith;
using testing::StartsWith;

using testing::HasSubstr;
using testing::Not;

constexpr const char* kText = "text that is long enough to be worth a compression, or to cut";

/// A server that answers to POST /echo with the body, which may have 16 bytes, to GET /text with a
/// text, and to GET /error not at all.
class HttpServerTest : public testing::Test {
 protected:
  void SetUp() override {
    server_.Post("/echo", [](const httplib::Request& request, httplib::Response& response) {
      response.set_content("<" + request.body + ">", "text/plain");
    });
    server_.Get("/text", [](const httplib::Request&, httplib::Response& response) {
      response.set_content(kText, "text/plain");
    });
    server_.Get("/error", [](const httplib::Request&, httplib::Response&) { throw 1; });
    server_.set_payload_max_length(16);
    port_ = server_.bind_to_any_port("127.0.0.1");
    ASSERT_GT(port_, 0);
    thread_ = std::thread([this] { server_.serve([] { return false; }); });
    while (!server_.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  void TearDown() override {
    if (!thread_.joinable()) return;
    server_.end();
    server_.stop();
    thread_.join();
  }

  /// Sends bytes, with the connection left open, and returns all that comes back.
  std::string answer_to(const std::string& bytes) const {
    const int out = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port_));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(connect(out, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    EXPECT_EQ(send(out, bytes.data(), bytes.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(bytes.size()));
    std::string text;
    std::array<char, 4096> piece{};
    for (ssize_t size = 0; (size = recv(out, piece.data(), piece.size(), 0)) > 0;)
      text.append(piece.data(), static_cast<std::size_t>(size));
    close(out);
    return text;
  }

 private:
  HttpServer server_;
  int port_ = 0;
  std::thread thread_;
};

TEST_F(HttpServerTest, ARequestWithoutALengthHasNoBody) {
  const std::string answer = answer_to("POST /echo HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_THAT(answer, StartsWith("HTTP/1.1 200 "));
  EXPECT_THAT(answer, EndsWith("\r\n\r\n<>"));
}

TEST_F(HttpServerTest, BodiesWithALengthOrInChunksAreRead) {
  const std::string head = "POST /echo HTTP/1.1\r\nHost: localhost\r\n";
  EXPECT_THAT(answer_to(head + "content-length: 5\r\n\r\nhello"), EndsWith("\r\n\r\n<hello>"));
  EXPECT_THAT(answer_to(head + "Transfer-Encoding: chunked\r\n\r\n5\r\nhello\r\n0\r\n\r\n"),
              EndsWith("\r\n\r\n<hello>"));
}

TEST_F(HttpServerTest, BodiesBeyondTheLimitAreRefused) {
  EXPECT_THAT(answer_to("POST /echo HTTP/1.1\r\nHost: localhost\r\nContent-Length: 17\r\n\r\n" +
                        std::string(17, 'x')),
              StartsWith("HTTP/1.1 413 "));
}

TEST_F(HttpServerTest, ChunksBeyondTheLimitAreRefused) {
  std::string body;
  for (int i = 0; i < 512; ++i) body += "10\r\n0123456789abcdef\r\n";
  EXPECT_THAT(answer_to("POST /echo HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n"
                        "\r\n" +
                        body + "0\r\n\r\n"),
              StartsWith("HTTP/1.1 4"));
}

TEST_F(HttpServerTest, BodiesStayAsTheyAreSent) {
  EXPECT_THAT(answer_to("POST /echo HTTP/1.1\r\nContent-Encoding: gzip\r\nContent-Length: 5\r\n"
                        "Content-Type: application/x-www-form-urlencoded\r\n\r\nhello"),
              EndsWith("\r\n\r\n<hello>"));
}

TEST_F(HttpServerTest, AnswersAreWholeAndNotCompressed) {
  for (const char* field : {"Range: bytes=0-0", "Range: bytes=0-3,5-6,1-", "Range: bytes=x",
                            "Accept-Encoding: gzip, deflate, br", "Expect: 100-continue"}) {
    const std::string answer =
        answer_to(std::string("GET /text HTTP/1.1\r\nHost: localhost\r\n") + field + "\r\n\r\n");
    EXPECT_THAT(answer, StartsWith("HTTP/1.1 200 ")) << field;
    EXPECT_THAT(answer, EndsWith(std::string("\r\n\r\n") + kText)) << field;
    EXPECT_THAT(answer, Not(HasSubstr("Content-Encoding"))) << field;
  }
}

TEST_F(HttpServerTest, HeadsBeyondTheLimitAreRefused) {
  const std::string line = "GET /text HTTP/1.1\r\n";
  std::string fields;
  while (fields.size() <= 16 << 10) fields += "Accept-Language: en\r\n";
  EXPECT_THAT(answer_to(line + fields + "\r\n"), StartsWith("HTTP/1.1 431 "));
  EXPECT_THAT(answer_to("GET /" + std::string(17 << 10, 'a')), StartsWith("HTTP/1.1 431 "));
  fields.resize(8 << 10);
  EXPECT_THAT(answer_to(line + fields + "\r\n\r\n"), StartsWith("HTTP/1.1 200 "));
}

TEST_F(HttpServerTest, ExceptionsEndAConnectionOnly) {
  EXPECT_THAT(answer_to("GET /error HTTP/1.1\r\n\r\n"), StartsWith("HTTP/1.1 500 "));
  EXPECT_THAT(answer_to("GET /text HTTP/1.1\r\n\r\n"), StartsWith("HTTP/1.1 200 "));
}

TEST(RequestHead, KeepsTheFieldsOfThePage) {
  EXPECT_EQ(used_head("GET / HTTP/1.1\r\nhost: a\r\nRange: bytes=0-\r\nHostile: b\r\nCookie:c=d\r\n"
                      " folded\r\nno field\r\n\r\n"),
            "GET / HTTP/1.1\r\nhost: a\r\nCookie:c=d\r\n\r\n");
  EXPECT_EQ(used_head("GET / HTTP/1.1\r\n\r\n"), "GET / HTTP/1.1\r\n\r\n");
}

TEST(RequestQueue, RefusesWhatItHasNoRoomFor) {
  RequestQueue queue(1, 1);
  std::latch begun(1), may_end(1);
  std::atomic<int> done = 0;
  queue.enqueue([&] {
    begun.count_down();
    may_end.wait();
    ++done;
  });
  begun.wait();
  queue.enqueue([&] { done += RequestQueue::refuses() ? 100 : 1; });
  bool refused = false;
  queue.enqueue([&] { refused = RequestQueue::refuses(); });
  EXPECT_TRUE(refused);
  EXPECT_FALSE(RequestQueue::refuses());
  may_end.count_down();
  queue.shutdown();
  EXPECT_EQ(done, 2);
}

}  // namespace
}  // namespace hypotrack
