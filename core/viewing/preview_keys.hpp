#pragma once

#include <array>

#include "viewing/run_controls.hpp"

namespace hypotrack {

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
