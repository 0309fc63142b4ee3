#pragma once

#include "hypotrack/api/error.hpp"
#include "messages.hpp"
#include "output/recording/recording_writer.hpp"

namespace hypotrack::app {

/// Calls a function that writes a recording. If that fails, completes the recording with the frames
/// that are whole, says how many, and throws the error again.
template <class Function>
void keeping_frames(RecordingWriter& writer, const Function& function) {
  try {
    function();
  } catch (const OutputError&) {
    try {
      if (const int frames = writer.finish_after_error(); frames > 0)
        tell("the recording ends early; {} holds its first {} frames\n", writer.place().string(),
             frames);
    } catch (const OutputError& error) {
      tell("{}\n", error.what());
    }
    throw;
  }
}

}  // namespace hypotrack::app
