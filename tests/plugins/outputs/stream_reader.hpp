#pragma once

#include <poll.h>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace hypotrack::test {

/// Reads the lines of a stream. `Protocol`: that of a TCP port or of a socket file.
template <class Protocol>
class StreamReader {
 public:
  explicit StreamReader(const typename Protocol::endpoint& at) : stream_(at) {}

  /// Returns the next line; nothing when the connection is closed.
  std::optional<std::string> line() {
    std::string text;
    if (!std::getline(stream_, text)) return std::nullopt;
    return text;
  }
  /// Returns the next line as JSON; null when the connection is closed.
  nlohmann::json json() {
    const auto text = line();
    return text ? nlohmann::json::parse(*text) : nlohmann::json();
  }
  /// Waits until the other side has closed the connection, and reads nothing.
  void wait_for_end() {
    pollfd one{stream_.socket().native_handle(), POLLRDHUP, 0};
    poll(&one, 1, -1);
  }
  /// Tells the other side that nothing more comes from here.
  void end_sending() { stream_.socket().shutdown(boost::asio::socket_base::shutdown_send); }
  bool connected() const { return stream_.good(); }
  void close() { stream_.close(); }

 private:
  typename Protocol::iostream stream_;
};

using LocalReader = StreamReader<boost::asio::local::stream_protocol>;
using TcpReader = StreamReader<boost::asio::ip::tcp>;

inline LocalReader read_socket(const std::filesystem::path& file) {
  return LocalReader(boost::asio::local::stream_protocol::endpoint(file.string()));
}

}  // namespace hypotrack::test
