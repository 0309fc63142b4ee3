#include "viewing/recorder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>

#include "config/yaml.hpp"
#include "hypotrack/api/pose.hpp"

namespace hypotrack {
namespace {

/// Returns a folder that does not exist yet: recording_000012, recording_000012_2, ...
std::filesystem::path new_folder(const std::filesystem::path& parent, int frame) {
  const std::string name = fmt::format("recording_{:06}", frame);
  std::filesystem::path out = parent / name;
  for (int i = 2; std::filesystem::exists(out); ++i) out = parent / fmt::format("{}_{}", name, i);
  return out;
}

/// Returns the YAML of a scene that starts where the models are, if all are found.
std::string started_at(const std::string& yaml, const Scene& scene, const Solution& solution) {
  const auto found = [](Status s) { return s == Status::tracked || s == Status::uncertain; };
  if (!std::ranges::all_of(solution.models, found)) return yaml;
  const std::vector<bool> all(scene.items().size(), true);
  detail::YamlDocument init;
  init.set_string("from", "rest");
  init.set("pose", detail::YamlDocument(pose_yaml(scene, solution.state, all)));
  detail::YamlDocument document(yaml);
  document.set("init", init);
  return document.text();
}

}  // namespace

void Recorder::open(const OpenedScene& opened) {
  scene_ = opened.scene.get();
  cameras_ = opened.source->cameras();
  frame_rate_ = opened.source->frame_rate();
  resolved_ = opened.resolved;
}

void Recorder::start(const Solution& solution) {
  writer_ = std::make_unique<RecordingWriter>(*scene_, cameras_, frame_rate_,
                                              started_at(resolved_, *scene_, solution),
                                              new_folder(folder_->path(), solution.frame));
  frames_ = 0;
  say_(folder_->shown(fmt::format("recording into {}", writer_->place().string())));
}

bool Recorder::add(const Frame& frame, const Solution& solution) {
  if (!writer_ && frame.views.empty()) return true;
  try {
    if (!writer_) start(solution);
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
    const std::string place = folder_->shown(writer_->place().string());
    writer_.reset();
    say_(fmt::format("{} frames are recorded in {}", frames_, place));
  } catch (const std::exception& e) {
    fail(e.what());
  }
}

void Recorder::fail(const std::string& why) {
  writer_.reset();
  say_(folder_->shown(fmt::format("nothing is recorded: {}", why)));
}

std::optional<int> Recorder::recorded() const {
  return writer_ ? std::optional(frames_) : std::nullopt;
}

}  // namespace hypotrack
