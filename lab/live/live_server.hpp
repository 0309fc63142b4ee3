#pragma once

#include <memory>
#include <string>

#include "base/exported.hpp"
#include "lab/live/access.hpp"
#include "lab/live/live_state.hpp"
#include "lab/live/view_pictures.hpp"
#include "viewing/run_controls.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Serves the live view by HTTP/1.1, in threads of its own:
///
///   GET /, /live.js, ...        the page and its files
///   GET /state, /events         the newest state; all states as Server-Sent Events
///   GET /solutions              solution_json() of the frames as Server-Sent Events
///   GET /scene, /history        shapes of the models; numbers of the last minutes
///   GET /pictures/row, /column  all views, as multipart/x-mixed-replace
///   POST /pause, /resume, /step, /restart, /snapshot
///
/// A reader that is late skips pictures and states. One that takes nothing for some seconds is
/// dropped.
class LiveServer {
 public:
  /// What is served; all must outlive the server.
  struct Parts {
    LiveState& state;
    ViewPictures& pictures;
    RunControls& controls;
  };

  /// Listens on a port; 0: any that is free. Throws ConfigError if that is not possible.
  LiveServer(const AccessRules& rules, int port, Parts parts);
  /// Ends all connections.
  ~LiveServer();
  LiveServer(const LiveServer&) = delete;
  LiveServer& operator=(const LiveServer&) = delete;

  int port() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace internal
}  // namespace hypotrack
