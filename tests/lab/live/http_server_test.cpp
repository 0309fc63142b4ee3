#include "lab/live/http_server.hpp"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <string>
#include <thread>

namespace hypotrack {
namespace {

using testing::EndsWith;
using testing::StartsWith;

/// A server that answers to POST /echo with the body, which may have 16 bytes.
class HttpServerTest : public testing::Test {
 protected:
  void SetUp() override {
    server_.Post("/echo", [](const httplib::Request& request, httplib::Response& response) {
      response.set_content("<" + request.body + ">", "text/plain");
    });
    server_.set_payload_max_length(16);
    port_ = server_.bind_to_any_port("127.0.0.1");
    ASSERT_GT(port_, 0);
    thread_ = std::thread([this] { server_.listen_after_bind(); });
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

}  // namespace
}  // namespace hypotrack
