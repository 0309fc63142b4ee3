#include "lab/live/http_server.hpp"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>

namespace hypotrack::internal {
namespace {

/// The connection of one client.
class Connection final : public httplib::Stream {
 public:
  Connection(socket_t socket, const HttpServer& server) : socket_(socket), server_(server) {}
  ~Connection() override {
    shutdown(socket_, SHUT_RDWR);
    close(socket_);
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Waits for bytes of the request until the time for it is over or the server ends.
  bool is_readable() const override {
    constexpr std::chrono::milliseconds kPeriod{50};
    while (!server_.ended() && Clock::now() < deadline_)
      if (ready(POLLIN, kPeriod)) return true;
    return false;
  }
  /// Waits for a moment for a client that takes bytes, not at all when the server has ended.
  bool is_writable() const override {
    constexpr std::chrono::milliseconds kMoment{250};
    const std::chrono::milliseconds time = server_.ended() ? std::chrono::milliseconds(0) : kMoment;
    return ready(POLLOUT, time) && is_open();
  }
  ssize_t read(char* bytes, std::size_t size) override;
  ssize_t write(const char* bytes, std::size_t size) override;
  void get_remote_ip_and_port(std::string& ip, int& port) const override {
    name(getpeername, ip, port);
  }
  void get_local_ip_and_port(std::string& ip, int& port) const override {
    name(getsockname, ip, port);
  }
  socket_t socket() const override { return socket_; }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds kTimeOfRequest{5};

  bool ready(short events, std::chrono::milliseconds time) const {
    pollfd wanted{.fd = socket_, .events = events, .revents = 0};
    return poll(&wanted, 1, static_cast<int>(time.count())) > 0;
  }
  /// Returns false if the client has hung up.
  bool is_open() const {
    char next = 0;
    const ssize_t seen = ::recv(socket_, &next, 1, MSG_PEEK | MSG_DONTWAIT);
    return seen > 0 || (seen < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR));
  }
  template <class Function>
  void name(Function function, std::string& ip, int& port) const;

  socket_t socket_;
  const HttpServer& server_;
  Clock::time_point deadline_ = Clock::now() + kTimeOfRequest;
  std::array<char, 4096> received_{};
  std::size_t begin_ = 0, end_ = 0;  ///< of what was received and not read yet
};

ssize_t Connection::read(char* bytes, std::size_t size) {
  if (begin_ == end_) {
    if (!is_readable()) return -1;
    const ssize_t count = ::recv(socket_, received_.data(), received_.size(), 0);
    if (count <= 0) return count;
    begin_ = 0;
    end_ = static_cast<std::size_t>(count);
  }
  const std::size_t count = std::min(size, end_ - begin_);
  std::memcpy(bytes, received_.data() + begin_, count);
  begin_ += count;
  return static_cast<ssize_t>(count);
}

ssize_t Connection::write(const char* bytes, std::size_t size) {
  if (!is_writable()) return -1;
  return ::send(socket_, bytes, size, MSG_NOSIGNAL | MSG_DONTWAIT);
}

template <class Function>
void Connection::name(Function function, std::string& ip, int& port) const {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  if (function(socket_, reinterpret_cast<sockaddr*>(&address), &size) != 0) return;
  std::array<char, INET6_ADDRSTRLEN> text{};
  const bool v6 = address.ss_family == AF_INET6;
  const auto* const v4_address = reinterpret_cast<const sockaddr_in*>(&address);
  const auto* const v6_address = reinterpret_cast<const sockaddr_in6*>(&address);
  const void* const number = v6 ? static_cast<const void*>(&v6_address->sin6_addr)
                                : static_cast<const void*>(&v4_address->sin_addr);
  if (inet_ntop(address.ss_family, number, text.data(), text.size())) ip = text.data();
  port = ntohs(v6 ? v6_address->sin6_port : v4_address->sin_port);
}

/// Gives a request without a length the length 0, which it has by RFC 9112, section 6.3. httplib
/// would take all that comes until the client hangs up for its body.
void complete(httplib::Request& request) {
  if (!request.has_header("Content-Length") && !request.has_header("Transfer-Encoding"))
    request.set_header("Content-Length", "0");
}

}  // namespace

bool HttpServer::process_and_close_socket(socket_t socket) {
  Connection connection(socket, *this);
  bool closed = false;
  return process_request(connection, true, closed, complete);
}

}  // namespace hypotrack::internal
