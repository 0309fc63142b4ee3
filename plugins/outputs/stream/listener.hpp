#pragma once

#include <boost/asio/basic_socket_acceptor.hpp>
#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <filesystem>
#include <functional>

#include "address.hpp"

namespace hypotrack::stream {

using Socket = boost::asio::generic::stream_protocol::socket;

/// Waits for connections at an address.
class Listener {
 public:
  /// Listens. A socket file on which nobody listens any more is replaced. Throws OutputError,
  /// naming the address, if that is not possible.
  Listener(boost::asio::io_context& io, const Address& address);
  /// Removes the socket file.
  ~Listener();
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  /// Passes on every connection, until close().
  void accept(std::function<void(Socket)> take);
  void close();

 private:
  using Acceptor = boost::asio::basic_socket_acceptor<boost::asio::generic::stream_protocol>;

  void accept_next();

  Acceptor acceptor_;
  boost::asio::steady_timer pause_;
  std::function<void(Socket)> take_;
  std::filesystem::path file_;  ///< to be removed; empty: none
};

}  // namespace hypotrack::stream
