#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "hypotrack/frame.hpp"
#include "hypotrack/output.hpp"
#include "hypotrack/solution.hpp"

namespace hypotrack {

struct LiveViewOptions {
  std::string host = "127.0.0.1";
  int port = 0;  ///< 0: any that is free
  std::string token = {};
};

/// A web page that shows a run while it tracks, and steers it. Functions are called from the thread
/// that tracks. The page ends with the object.
class LiveView {
 public:
  LiveView() = default;
  virtual ~LiveView() = default;
  LiveView(const LiveView&) = delete;
  LiveView& operator=(const LiveView&) = delete;

  /// Returns the page's address, token included.
  virtual std::string address() const = 0;

  /// Returns the output that connects the view with a run: it writes the snapshots. The view must
  /// outlive it.
  virtual std::unique_ptr<Output> output() = 0;

  /// Is called before the first frame, with the number of frames if it is known.
  virtual void begin(std::optional<int> frames) = 0;
  /// Shows a frame. `error`: mean distance from the ground truth, metres; NaN: unknown.
  virtual void frame(const Frame& frame, const Solution& solution, double error) = 0;
  /// Waits while the viewer pauses the run, or until `interrupted` returns true.
  virtual void wait_while_paused(const std::function<bool()>& interrupted) = 0;
  /// Returns true once if the viewer wants the models to be looked for again.
  virtual bool take_restart() = 0;
};

/// Listens and returns the page. Throws ConfigError if the port cannot be used, or if others could
/// see the run without a token.
std::unique_ptr<LiveView> open_live_view(const LiveViewOptions& options);

}  // namespace hypotrack
