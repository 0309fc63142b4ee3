#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

#include "calibrate/picture_pairs.hpp"
#include "config/yaml.hpp"
#include "hypotrack/api/error.hpp"
#include "new_scene/scene_request.hpp"

namespace hypotrack::app {
namespace {

using detail::YamlDocument;

/// Writes a path relative to a folder if it lies at most two folders up from there.
std::string near_path(const std::filesystem::path& path, const std::filesystem::path& folder) {
  constexpr int kMostUp = 2;
  const std::filesystem::path absolute = std::filesystem::absolute(path).lexically_normal();
  const std::filesystem::path base =
      std::filesystem::absolute(folder.empty() ? "." : folder).lexically_normal() / "";
  std::filesystem::path above = base.parent_path();
  for (int up = 0; up <= kMostUp && above != above.root_path(); ++up, above = above.parent_path()) {
    const std::filesystem::path below = absolute.lexically_relative(above);
    if (!below.empty() && *below.begin() != "..") return absolute.lexically_relative(base).string();
  }
  return absolute.string();
}

YamlDocument model(const std::string& name, const std::string& type) {
  YamlDocument out;
  out.set_string("name", name);
  out.set_string("type", type);
  return out;
}

std::vector<YamlDocument> models(const SceneRequest& request) {
  std::vector<YamlDocument> out;
  if (request.model == "two_hands") {
    out.push_back(model("right", "hand"));
    out.push_back(model("left", "mirrored_hand"));
    return out;
  }
  if (request.model != "box")
    out.push_back(model("hand", request.model == "left_hand" ? "mirrored_hand" : "hand"));
  if (request.model == "hand_and_box" || request.model == "box") {
    const Eigen::Vector3d& size = request.box_mm;
    out.emplace_back(fmt::format("{{name: box, type: rigid_box, size_mm: [{}, {}, {}]}}", size.x(),
                                 size.y(), size.z()));
  }
  return out;
}

/// Returns the source of pictures or videos, without its calibration.
YamlDocument file_source(const RecordingFiles& files, const std::filesystem::path& folder) {
  YamlDocument out;
  const bool one = !files.side_by_side.empty();
  const std::filesystem::path& left = one ? files.side_by_side : files.left;
  out.set_string("type", calibrate::is_video(left) ? "video" : "image_sequence");
  out.set_string(one && !files.layout ? "side_by_side" : "left", near_path(left, folder));
  if (files.layout) out.set_string("layout", *files.layout);
  if (!files.right.empty()) out.set_string("right", near_path(files.right, folder));
  return out;
}

YamlDocument source(const SceneRequest& request, const std::filesystem::path& folder) {
  const RecordingFiles& files = request.recording;
  YamlDocument out = files.live ? camera_source(*files.live) : file_source(files, folder);
  YamlDocument calibration;
  if (!request.cameras.empty()) calibration.set_strings("cameras", request.cameras);
  calibration.set_string("file", near_path(files.calibration, folder));
  if (!files.extrinsics.empty())
    calibration.set_string("extrinsics", near_path(files.extrinsics, folder));
  if (!request.units.empty()) calibration.set_string("units", request.units);
  if (request.scale) calibration.set_plain("scale", fmt::format("{}", *request.scale));
  out.set("calibration", calibration);
  return out;
}

/// Throws unless a tracker of objects is for an object, and no other one is but recommended.
void check_tracker_of_object(const SceneRequest& request) {
  const bool object = request.model == "box";
  const bool good = request.tracker == "recommended" || object == (request.tracker == "rigid");
  if (good) return;
  throw ConfigError(
      fmt::format("--tracker {} tracks {}, found --model {}; expected --tracker {} or recommended",
                  request.tracker, object ? "hands" : "rigid objects", request.model,
                  object ? "rigid" : "real"));
}

std::string tracker_name(const SceneRequest& request) {
  check_tracker_of_object(request);
  const bool two_hands = request.model == "two_hands";
  if (request.tracker == "real_time" && (two_hands || request.model == "hand_and_box"))
    throw ConfigError(
        fmt::format("--tracker real_time tracks one hand, found --model {}; expected --tracker "
                    "real or recommended",
                    request.model));
  if (!two_hands) return "@trackers/" + request.tracker;
  return request.tracker == "real" ? "@trackers/real_two_hands" : "@trackers/two_hands";
}

/// Sets what a live camera must not wait for: searches in another thread, and no video.
void set_live(YamlDocument& scene) {
  YamlDocument recovery, output;
  recovery.set_string("run", "background");
  scene.set("recovery", recovery);
  output.set_plain("overlay", "false");
  scene.set("output", output);
}

}  // namespace

std::string scene_text(const SceneRequest& request, const std::filesystem::path& folder) {
  YamlDocument scene;
  scene.set_list("models", models(request));
  scene.set("source", source(request, folder));
  const bool live = request.recording.live.has_value();
  scene.set_string("tracker", tracker_name(request));
  if (live) set_live(scene);
  YamlDocument init;
  init.set_string("from", "auto");
  scene.set("init", init);
  if (!live && request.tracker == "real") {  // which has the hand detector, as this needs
    YamlDocument shape;
    shape.set_plain("estimate_s", "2");
    shape.set_string("from", "starters");
    scene.set("shape", shape);
  }
  return scene.text();
}

}  // namespace hypotrack::app
