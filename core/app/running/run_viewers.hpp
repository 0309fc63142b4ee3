#pragma once

#include <optional>

#include "command_line.hpp"
#include "lab/live/live_view.hpp"
#include "running/web_token.hpp"
#include "viewing/live_run.hpp"

namespace hypotrack::app {

/// How a run is shown while it tracks.
struct ViewerOptions {
  bool preview = false;
  std::optional<int> web_port;
  LiveViewOptions web;  ///< without port and token
  WebTokenSources token;
};
/// Takes the token's variable out of the environment, too.
void add_viewer_options(const Command& command, ViewerOptions& options);

/// Opens the viewers that are wanted, and says where the page is. Throws ConfigError or DeviceError
/// if one cannot be opened.
void open_viewers(const ViewerOptions& options, LiveRun& live);

}  // namespace hypotrack::app
