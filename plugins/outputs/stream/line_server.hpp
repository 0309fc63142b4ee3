#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "listener.hpp"
#include "reader.hpp"

namespace hypotrack::stream {

/// Sends lines of JSON objects to all who connect, in a thread of its own. Never waits for a
/// reader, except in finish().
class LineServer {
 public:
  /// Listens. `greeting` is the first line that a reader gets. Throws OutputError.
  LineServer(const Address& address, std::string greeting, const Patience& patience);
  /// Ends all connections at once.
  ~LineServer();
  LineServer(const LineServer&) = delete;
  LineServer& operator=(const LineServer&) = delete;

  /// Sends a line to the readers that are connected.
  void send(std::string line);

  /// Takes no more readers, waits until all lines are sent, `most` at the longest, and ends all
  /// connections.
  void finish(std::chrono::milliseconds most);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hypotrack::stream
