#pragma once

#include <sys/types.h>

#include <boost/asio/basic_socket_acceptor.hpp>
#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <filesystem>
#include <functional>
#include <string>

namespace hypotrack::stream {

/// Where readers connect: a socket file, or a TCP port of a host if that is empty.
struct Address {
  std::filesystem::path socket;
  std::string host;
  int port = 0;
  std::string where = {};  ///< place of the parameters, for messages

  /// Returns the address for messages.
  std::string text() const {
    if (!socket.empty()) return socket.string();
    return "port " + std::to_string(port) + " of " + host;
  }
};

using Socket = boost::asio::generic::stream_protocol::socket;

/// Waits for connections at an address.
class Listener {
 public:
  /// Listens. A socket file on which nobody listens any more is replaced. Throws OutputError,
  /// naming the address, if that is not possible.
  Listener(boost::asio::io_context& io, const Address& address);
  /// As close().
  ~Listener();
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  /// Passes on every connection, until close().
  void accept(std::function<void(Socket)> take);
  /// Removes the socket file, if it is still this one's, and listens no more.
  void close();

 private:
  using Acceptor = boost::asio::basic_socket_acceptor<boost::asio::generic::stream_protocol>;

  void accept_next();
  void note_file(const std::filesystem::path& file);
  void remove_file();

  Acceptor acceptor_;
  boost::asio::steady_timer pause_;
  std::function<void(Socket)> take_;
  std::filesystem::path file_;  ///< to be removed; empty: none
  dev_t device_ = 0;            ///< of the file
  ino_t inode_ = 0;
};

}  // namespace hypotrack::stream
