#pragma once

#include <filesystem>
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

}  // namespace hypotrack::stream
