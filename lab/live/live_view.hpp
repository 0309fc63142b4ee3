#pragma once

#include <memory>
#include <string>

#include "base/exported.hpp"
#include "viewing/run_controls.hpp"
#include "viewing/viewer.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

struct LiveViewOptions {
  std::string host = "127.0.0.1";
  int port = 0;  ///< 0: any that is free
  std::string token = {};
  std::string token_source = "--web-token";  ///< as messages name it
};

/// A web page that shows a run while it tracks, and steers it. The page ends with the object.
class LiveView : public Viewer {
 public:
  /// Returns the page's address, token included.
  virtual std::string address() const = 0;
};

/// Listens and returns the page. `controls` must outlive it. Throws ConfigError if the port cannot
/// be used, or if others could see the run without a token.
std::unique_ptr<LiveView> open_live_view(const LiveViewOptions& options, RunControls& controls);

}  // namespace internal
}  // namespace hypotrack
