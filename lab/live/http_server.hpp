#pragma once

#include <httplib.h>

#include <atomic>
#include <functional>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// An HTTP server that takes one request of each connection, within some seconds, and that no
/// client can keep from ending. A request without a length has no body.
///
/// Limits, above which a client is refused: 16 KiB and 5 s for the head of a request; 4 KiB more
/// than set_payload_max_length() for its body, however it is sent; the connections of the
/// RequestQueue. Answers are whole and not compressed. Exceptions end a connection, not the server.
class HttpServer final : public httplib::Server {
 public:
  /// Serves until end() is called. `relisten` binds the port again after an error of its socket.
  void serve(const std::function<bool()>& relisten);
  /// Ends what waits for clients. Streams may still send what they have.
  void end() { ended_ = true; }
  bool ended() const { return ended_; }

 private:
  bool process_and_close_socket(socket_t socket) override;
  template <class Connection>
  bool answer(Connection& connection);

  std::atomic<bool> ended_ = false;
};

}  // namespace internal
}  // namespace hypotrack
