#include "lab/live/connection.hpp"

#include <arpa/inet.h>
#include <poll.h>
#include <strings.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>

namespace hypotrack::internal {
namespace {

constexpr std::array<std::string_view, 8> kUsed = {
    "Host",          "Origin", "Sec-Fetch-Site", "Sec-Fetch-Mode",
    "Authorization", "Cookie", "Content-Length", "Transfer-Encoding"};

bool is_used(std::string_view line) {
  const std::string_view name = line.substr(0, line.find(':'));
  return std::ranges::any_of(kUsed, [&](std::string_view used) {
    return used.size() == name.size() && strncasecmp(used.data(), name.data(), name.size()) == 0;
  });
}

constexpr std::size_t kMostHead = 16 << 10;

template <class Function>
void name(socket_t socket, Function function, std::string& ip, int& port) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  if (function(socket, reinterpret_cast<sockaddr*>(&address), &size) != 0) return;
  std::array<char, INET6_ADDRSTRLEN> text{};
  const bool v6 = address.ss_family == AF_INET6;
  const auto* const v4_address = reinterpret_cast<const sockaddr_in*>(&address);
  const auto* const v6_address = reinterpret_cast<const sockaddr_in6*>(&address);
  const void* const number = v6 ? static_cast<const void*>(&v6_address->sin6_addr)
                                : static_cast<const void*>(&v4_address->sin_addr);
  if (inet_ntop(address.ss_family, number, text.data(), text.size())) ip = text.data();
  port = ntohs(v6 ? v6_address->sin6_port : v4_address->sin_port);
}

}  // namespace

std::string used_head(std::string_view head) {
  constexpr std::string_view kEnd = "\r\n";
  std::string used;
  for (bool first = true; !head.empty(); first = false) {
    const std::size_t end = std::min(head.find(kEnd), head.size());
    const std::string_view line = head.substr(0, end);
    if (first || is_used(line)) (used += line) += kEnd;
    head.remove_prefix(std::min(end + kEnd.size(), head.size()));
  }
  return used += kEnd;
}

Connection::Connection(socket_t socket, const std::atomic<bool>& ended, std::size_t most_body)
    : socket_(socket), ended_(ended), most_(most_body) {}

Connection::~Connection() {
  drop_rest();
  shutdown(socket_, SHUT_RDWR);
  close(socket_);
}

/// Takes what a refused client has sent already: the kernel would drop the answer otherwise.
void Connection::drop_rest() noexcept {
  constexpr int kMostPieces = 64;
  std::array<char, 4096> piece{};
  shutdown(socket_, SHUT_WR);
  for (int i = 0; i < kMostPieces; ++i)
    if (::recv(socket_, piece.data(), piece.size(), MSG_DONTWAIT) <= 0) return;
}

bool Connection::ready(short events, std::chrono::milliseconds time) const {
  pollfd wanted{.fd = socket_, .events = events, .revents = 0};
  return poll(&wanted, 1, static_cast<int>(time.count())) > 0;
}

/// Returns false if the client has hung up.
bool Connection::is_open() const {
  char next = 0;
  const ssize_t seen = ::recv(socket_, &next, 1, MSG_PEEK | MSG_DONTWAIT);
  return seen > 0 || (seen < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR));
}

bool Connection::is_readable() const {
  constexpr std::chrono::milliseconds kPeriod{50};
  while (!ended_ && Clock::now() < deadline_)
    if (ready(POLLIN, kPeriod)) return true;
  return false;
}

bool Connection::is_writable() const {
  constexpr std::chrono::milliseconds kMoment{250};
  const std::chrono::milliseconds time = ended_ ? std::chrono::milliseconds(0) : kMoment;
  return ready(POLLOUT, time) && is_open();
}

ssize_t Connection::receive(std::size_t most) {
  std::array<char, 4096> piece{};
  if (most == 0 || !is_readable()) return -1;
  const ssize_t count = ::recv(socket_, piece.data(), std::min(most, piece.size()), 0);
  if (count > 0) received_.append(piece.data(), static_cast<std::size_t>(count));
  return count;
}

bool Connection::read_head() {
  constexpr std::string_view kEnd = "\r\n\r\n";
  std::size_t end = std::string::npos;
  while (end == std::string::npos) {
    if (received_.size() >= kMostHead) {
      refuse("431 Request Header Fields Too Large", "the head of the request is over 16 KiB");
      return false;
    }
    const std::size_t before = received_.size();
    const ssize_t count = receive(kMostHead - before);
    if (count == 0) return false;
    if (count < 0) {
      if (before > 0) refuse("408 Request Timeout", "the head of the request took over 5 s");
      return false;
    }
    end = received_.find(kEnd, before < kEnd.size() ? 0 : before - kEnd.size());
  }
  end += kEnd.size();
  std::string head = used_head(std::string_view(received_).substr(0, end - 2));
  most_ -= std::min(most_, received_.size() - end);
  received_.replace(0, end, head);
  return true;
}

void Connection::refuse(std::string_view status, std::string_view text) noexcept {
  if (answered_) return;
  answered_ = true;
  std::array<char, 512> answer{};
  const int size = std::snprintf(
      answer.data(), answer.size(),
      "HTTP/1.1 %.*s\r\nConnection: close\r\nContent-Type: text/plain; charset=utf-8\r\n"
      "Content-Length: %zu\r\n\r\nhypotrack: %.*s\n",
      static_cast<int>(status.size()), status.data(), text.size() + 12,
      static_cast<int>(text.size()), text.data());
  const std::size_t whole = std::min(static_cast<std::size_t>(std::max(size, 0)), answer.size());
  [[maybe_unused]] const ssize_t sent =
      ::send(socket_, answer.data(), whole, MSG_NOSIGNAL | MSG_DONTWAIT);
}

ssize_t Connection::read(char* bytes, std::size_t size) {
  if (begin_ == received_.size()) {
    received_.clear();
    begin_ = 0;
    const ssize_t count = receive(most_);
    if (count <= 0) return count;
    most_ -= static_cast<std::size_t>(count);
  }
  const std::size_t count = std::min(size, received_.size() - begin_);
  std::memcpy(bytes, received_.data() + begin_, count);
  begin_ += count;
  return static_cast<ssize_t>(count);
}

ssize_t Connection::write(const char* bytes, std::size_t size) {
  constexpr int kWaits = 16;
  answered_ = true;
  int waits = 0;
  while (!is_writable())
    if (ended_ || ++waits == kWaits) return -1;
  return ::send(socket_, bytes, size, MSG_NOSIGNAL | MSG_DONTWAIT);
}

void Connection::get_remote_ip_and_port(std::string& ip, int& port) const {
  name(socket_, getpeername, ip, port);
}

void Connection::get_local_ip_and_port(std::string& ip, int& port) const {
  name(socket_, getsockname, ip, port);
}

}  // namespace hypotrack::internal
