#pragma once

#include <httplib.h>

#include <atomic>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// An HTTP server that takes one request of each connection, within some seconds, and that no
/// client can keep from ending. A request without a length has no body.
class HttpServer final : public httplib::Server {
 public:
  /// Ends what waits for clients. Streams may still send what they have.
  void end() { ended_ = true; }
  bool ended() const { return ended_; }

 private:
  bool process_and_close_socket(socket_t socket) override;

  std::atomic<bool> ended_ = false;
};

}  // namespace internal
}  // namespace hypotrack
