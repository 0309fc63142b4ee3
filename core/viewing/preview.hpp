#pragma once

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

}  // namespace hypotrack
