#include "viewing/recorder.hpp"

#include <fmt/format.h>

#include <exception>

namespace hypotrack {
namespace {

/// Returns a folder that does not exist yet: recording_000012, recording_000012_2, ...
std::filesystem::path new_folder(const std::filesystem::path& parent, int frame) {
  const std::string name = fmt::format("recording_{:06}", frame);
  std::filesystem::path out = parent / name;
  for (int i = 2; std::filesystem::exists(out); ++i) out = parent / fmt::format("{}_{}", name, i);
  return out;
}

}  // namespace

void Recorder::open(const OpenedScene& opened) {
  scene_ = opened.scene.get();
  cameras_ = opened.source->cameras();
  frame_rate_ = opened.source->frame_rate();
  resolved_ = opened.resolved;
}

void Recorder::start(int frame) {
  recording_ = new_folder(folder_, frame);
  writer_ =
      std::make_unique<RecordingWriter>(*scene_, cameras_, frame_rate_, resolved_, recording_);
  frames_ = 0;
  say_(fmt::format("recording into {}", recording_.string()));
}

bool Recorder::add(const Frame& frame) {
  if (!writer_ && frame.views.empty()) return true;
  try {
    if (!writer_) start(frame.index);
    writer_->add(frame);
    ++frames_;
    return true;
  } catch (const std::exception& e) {
    fail(e.what());
    return false;
  }
}

void Recorder::stop() {
  if (!writer_) return;
  try {
    writer_->finish();
    writer_.reset();
    say_(fmt::format("{} frames are recorded in {}", frames_, recording_.string()));
  } catch (const std::exception& e) {
    fail(e.what());
  }
}

void Recorder::fail(const std::string& why) {
  writer_.reset();
  say_(fmt::format("nothing is recorded: {}", why));
}

std::optional<int> Recorder::recorded() const {
  return writer_ ? std::optional(frames_) : std::nullopt;
}

}  // namespace hypotrack
