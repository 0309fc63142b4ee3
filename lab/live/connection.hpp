#pragma once

#include <httplib.h>

#include <atomic>
#include <chrono>
#include <string>
#include <string_view>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns the head of an HTTP request, up to and with its empty line, with the fields only that
/// the live page uses. The others ask for what the page does not do: parts of a file (Range),
/// compression, forms. A body in an encoding is refused later, as it keeps no length.
std::string used_head(std::string_view head);

/// The connection of one client, which has one request. Reads no more of it than the limits say,
/// and only for some seconds.
class Connection final : public httplib::Stream {
 public:
  /// Takes over the socket. `ended`: the server ends. `most_body`: bytes that may follow the head.
  Connection(socket_t socket, const std::atomic<bool>& ended, std::size_t most_body);
  ~Connection() override;
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Reads the head of the request, of which read() then returns used_head(). Returns false if the
  /// client has hung up, or was answered because its head is too large or late.
  bool read_head();
  /// Answers with a line of text, unless something was sent already. Does not wait.
  void refuse(std::string_view status, std::string_view text) noexcept;

  /// Waits for bytes of the request until the time for it is over or the server ends.
  bool is_readable() const override;
  /// Waits for a moment for a client that takes bytes, not at all when the server has ended.
  bool is_writable() const override;
  ssize_t read(char* bytes, std::size_t size) override;
  ssize_t write(const char* bytes, std::size_t size) override;
  void get_remote_ip_and_port(std::string& ip, int& port) const override;
  void get_local_ip_and_port(std::string& ip, int& port) const override;
  socket_t socket() const override { return socket_; }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds kTimeOfRequest{5};

  bool ready(short events, std::chrono::milliseconds time) const;
  bool is_open() const;
  /// Receives up to `most` bytes behind those received so far. Returns as recv(); -1: too late.
  ssize_t receive(std::size_t most);
  void drop_rest() noexcept;

  socket_t socket_;
  const std::atomic<bool>& ended_;
  std::size_t most_;  ///< bytes that may still be received
  Clock::time_point deadline_ = Clock::now() + kTimeOfRequest;
  std::string received_;
  std::size_t begin_ = 0;  ///< of what was not read yet
  bool answered_ = false;
};

}  // namespace internal
}  // namespace hypotrack
