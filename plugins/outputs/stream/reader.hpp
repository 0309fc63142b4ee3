#pragma once

#include <array>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <string>

#include "listener.hpp"

namespace hypotrack::stream {

/// A JSON object and the end of its line, shared by all readers.
using Line = std::shared_ptr<const std::string>;

/// How much a reader may lag behind.
struct Patience {
  std::size_t lines = 64;           ///< that wait for it; the oldest give way
  std::chrono::milliseconds hangs;  ///< after which one that takes nothing is dropped
};

/// Sends lines to one connected reader. All functions are called from one thread.
class Reader : public std::enable_shared_from_this<Reader> {
 public:
  /// Is called once, when the connection of a reader is closed.
  using Closed = std::function<void(const std::shared_ptr<Reader>&)>;

  Reader(Socket socket, const Patience& patience, Closed closed);

  /// Sends the first line, and drops what the reader sends.
  void start(const Line& greeting);
  /// Queues a line. The next line that is sent says how many were dropped since the last one.
  void add(const Line& line);
  /// Closes the connection when all lines are sent.
  void finish();

 private:
  void send(std::string text);
  void send_rest();
  void send_next();
  void receive();
  void close();

  Socket socket_;
  Patience patience_;
  Closed closed_;
  boost::asio::steady_timer timer_;
  std::deque<Line> waiting_;
  std::string unsent_;  ///< rest of the line that is being sent; empty: none
  std::size_t dropped_ = 0;
  std::array<char, 256> received_{};
  bool finishing_ = false;
};

}  // namespace hypotrack::stream
