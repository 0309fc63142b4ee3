#include <cctype>

#include "viewing/preview.hpp"

namespace hypotrack {

const std::array<PreviewKeyHelp, 7>& preview_key_help() {
  static const std::array<PreviewKeyHelp, 7> kHelp = {{
      {"space", "pause, go on"},
      {"n  .", "track one frame, then pause"},
      {"r", "look for the models again"},
      {"s", "snapshot: views and pose, into the results"},
      {"v", "record the source's pictures, stop recording"},
      {"h", "show or hide this help"},
      {"q  escape", "end the run; its results are kept"},
  }};
  return kHelp;
}

PreviewKey preview_key(char key) {
  constexpr char kEscape = 27;
  switch (std::tolower(static_cast<unsigned char>(key))) {
    case ' ':
      return PreviewKey::pause;
    case 'n':
    case '.':
      return PreviewKey::step;
    case 'r':
      return PreviewKey::restart;
    case 's':
      return PreviewKey::snapshot;
    case 'v':
      return PreviewKey::record;
    case 'h':
      return PreviewKey::help;
    case 'q':
    case kEscape:
      return PreviewKey::end;
    default:
      return PreviewKey::none;
  }
}

void press(RunControls& controls, PreviewKey key) {
  switch (key) {
    case PreviewKey::pause:
      return controls.toggle_pause();
    case PreviewKey::step:
      return controls.step();
    case PreviewKey::restart:
      return controls.ask_for_restart();
    case PreviewKey::snapshot:
      return controls.ask_for_snapshot();
    case PreviewKey::record:
      return controls.toggle_recording();
    case PreviewKey::end:
      return controls.ask_for_end();
    case PreviewKey::help:
    case PreviewKey::none:
      return;
  }
}

}  // namespace hypotrack
