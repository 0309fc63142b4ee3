#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>

#include "viewing/run_controls.hpp"
#include "viewing/viewer.hpp"
#include "window/window.hpp"

namespace hypotrack {

/// Opens a window that shows a run and steers it by keys, when the run begins. It is drawn in a
/// thread of its own, the newest frame only. Closing it ends the run. `controls` must outlive the
/// viewer. `warn` is called from that thread if the window fails.
std::unique_ptr<Viewer> make_preview(RunControls& controls, ShowWindow show_window,
                                     std::function<void(const std::string&)> warn);

/// What a key of the preview does.
enum class PreviewKey { pause, step, restart, snapshot, record, help, end, none };

struct PreviewKeyHelp {
  const char* keys;
  const char* text;
};

/// Returns the keys and what they do, for the user.
const std::array<PreviewKeyHelp, 7>& preview_key_help();

/// Returns the action of a key; letters of either case.
PreviewKey preview_key(char key);

/// Passes the action of a key on to the run, except help.
void press(RunControls& controls, PreviewKey key);

}  // namespace hypotrack
