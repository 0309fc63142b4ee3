#include "output/recording/recording_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <utility>

#include "base/text_file.hpp"
#include "config/yaml.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/files.hpp"
#include "hypotrack/plugin/params.hpp"
#include "output/evaluate/true_landmarks.hpp"
#include "output/recording/recording_folder.hpp"

namespace hypotrack::internal {
namespace {

constexpr double kDepthUnitMm = 0.1;

/// Returns a 16-bit image in kDepthUnitMm; 0: not measured or farther than 6.5535 m.
cv::Mat stored_depth(const cv::Mat& depth) {
  cv::Mat stored;
  const double unit = kDepthUnitMm * kMillimetre;
  depth.convertTo(stored, CV_16U, 1 / unit);
  stored.setTo(0, depth >= 65535.5 * unit);
  return stored;
}

}  // namespace

RecordingWriter::RecordingWriter(const Scene& scene, std::vector<Camera> cameras, double frame_rate,
                                 std::string scene_yaml, std::filesystem::path directory,
                                 PictureFormat format, int threads)
    : scene_(&scene),
      cameras_(std::move(cameras)),
      frame_rate_(frame_rate),
      scene_yaml_(std::move(scene_yaml)),
      format_(format),
      folder_(std::move(directory)),
      threads_(threads) {
  images_.emplace(threads_);
  if (cameras_.empty() || cameras_.size() > 2)
    throw DataError(
        fmt::format("a recording has one or two cameras, this source has {}", cameras_.size()));
}

void RecordingWriter::write_image(const std::string& name, int index, cv::Mat image,
                                  const char* extension) {
  extensions_[name] = extension;
  if (first_image_ < 0) first_image_ = index;
  last_image_ = index;
  if (frames_.empty() || frames_.back().first != index) frames_.push_back({index, {}});
  std::vector<std::filesystem::path>& files = frames_.back().second;
  files.push_back(folder_.file(fmt::format("{}_{:06}{}", name, index, extension)));
  images_->write(files.back(), std::move(image));
}

void RecordingWriter::drop_last() {
  const int index = frames_.back().first;
  std::error_code ignored;
  for (const auto& file : frames_.back().second) std::filesystem::remove(file, ignored);
  frames_.pop_back();
  const auto is_later = [index](const auto& row) { return row.frame >= index; };
  std::erase_if(states_, is_later);
  std::erase_if(seen_, is_later);
  std::erase_if(landmarks_, is_later);
  last_ = last_image_ = frames_.empty() ? -1 : frames_.back().first;
  times_.resize(static_cast<std::size_t>(frames_.empty() ? 0 : last_ - first_ + 1));
  stamps_.resize(times_.size());
}

int RecordingWriter::finish_after_error() {
  images_.emplace(threads_);  // drops the images that wait
  const auto is_whole = [](const std::filesystem::path& file) {
    return std::filesystem::exists(file);
  };
  const auto cut = std::ranges::find_if_not(
      frames_, [&](const auto& frame) { return std::ranges::all_of(frame.second, is_whole); });
  const auto whole = static_cast<std::size_t>(cut - frames_.begin());
  while (frames_.size() > whole) drop_last();
  return finish_where_it_fits();
}

int RecordingWriter::finish_where_it_fits() {
  while (!frames_.empty()) {
    try {
      finish();
      break;
    } catch (const OutputError&) {
      // Tables and scene need room, too.
      if (frames_.size() > 1 && !why_not_written(folder_.file("scene.yaml")).empty()) {
        for (std::size_t drop = frames_.size() / 10 + 1; drop > 0; --drop) drop_last();
        continue;
      }
      folder_.keep();
      throw;
    }
  }
  return static_cast<int>(frames_.size());
}

/// Spreads frames whose numbers are left out evenly.
void RecordingWriter::note_time(const Frame& frame) {
  const std::int64_t stamp = frame.stamp.value_or(0);
  stamped_ = stamped_ && frame.stamp && (first_ < 0 || stamp > stamps_.back());
  if (first_ < 0) {
    first_ = frame.index;
    times_.push_back(frame.time);
    stamps_.push_back(stamp);
  } else {
    const double before = times_.back();
    const std::int64_t stamp_before = stamps_.back();
    const int steps = frame.index - last_;
    for (int k = 1; k <= steps; ++k) {
      times_.push_back(k == steps ? frame.time : before + (frame.time - before) * k / steps);
      stamps_.push_back(k == steps ? stamp : stamp_before + (stamp - stamp_before) / steps * k);
    }
  }
  last_ = frame.index;
}

bool RecordingWriter::evenly_spaced() const {
  constexpr double kSame = 1e-6;  // seconds
  for (std::size_t i = 0; i < times_.size(); ++i) {
    const double expected = times_[0] + static_cast<double>(i) / frame_rate_;
    if (std::abs(times_[i] - expected) > kSame) return false;
  }
  return true;
}

void RecordingWriter::write_times() const {
  std::string text = "frame,time\n";
  for (int i = first_image_; i <= last_image_; ++i) {
    const auto at = static_cast<std::size_t>(i - first_);
    text += fmt::format("{},{}\n", i,
                        stamped_ ? stamp_text(stamps_[at]) : fmt::format("{:.9f}", times_[at]));
  }
  TextFile(folder_.file("times.csv")).write(text);
}

void RecordingWriter::copy_start(const InitSettings& init) {
  folder_.write_with([&] { init_yaml_ = copy_start_files(init, folder_.file()); });
}

void RecordingWriter::add_pictures(const Frame& frame) {
  note_time(frame);
  for (std::size_t i = 0; i < frame.views.size(); ++i) {
    const View& view = frame.views[i];
    const std::string side = i == 0 ? "left" : "right";
    const char* const color = format_ == PictureFormat::jpeg  ? ".jpg"
                              : format_ == PictureFormat::ppm ? ".ppm"
                                                              : ".png";
    const char* const grey = format_ == PictureFormat::ppm ? ".pgm" : ".png";
    if (!view.color.empty()) write_image(side, frame.index, view.color, color);
    if (!view.mask.empty()) write_image(side + "_mask", frame.index, view.mask, grey);
    if (!view.depth.empty())
      write_image(side + "_depth", frame.index, stored_depth(view.depth), grey);
  }
}

void RecordingWriter::add(const Frame& frame) {
  folder_.write_with([&] { add_pictures(frame); });
  if (!frame.truth) return;
  if (frame.truth->state.size() > 0) {
    states_.push_back({frame.index, frame.time, frame.truth->state});
    if (frame.truth->absent.empty()) seen_.push_back(states_.back());
  }
  if (auto landmarks = true_landmarks(*scene_, frame))
    landmarks_.push_back({frame.index, frame.time, *std::move(landmarks),
                          absent_landmarks(*scene_, frame.truth->absent)});
}

std::vector<ModelSpeeds> RecordingWriter::motion() const {
  if (seen_.empty()) return {};
  return motion_speeds(*scene_, seen_);
}

void RecordingWriter::write_truth() const {
  if (!states_.empty()) {
    write_states(folder_.file("truth_states.csv"), *scene_, states_);
    write_whole(folder_.file("motion.json"), motion_json(motion()));
  }
  if (!landmarks_.empty())
    write_landmarks(folder_.file("truth_landmarks.csv"), scene_->landmark_names(), landmarks_);
}

void RecordingWriter::write_scene() const {
  detail::YamlDocument calibration;
  calibration.set_string("file", "calibration.yaml");
  detail::YamlDocument source;
  source.set_string("type", "image_sequence");
  for (const auto& [name, extension] : extensions_)
    source.set_string(name, name + "_%06d" + extension);
  if (extensions_.contains("left_depth")) {
    source.set_plain("depth_units_mm", fmt::format("{}", kDepthUnitMm));
  }
  if ((evenly_spaced() && !stamped_) || first_image_ < 0) {
    source.set_plain("start", std::to_string(first_));
    source.set_plain("count", std::to_string(last_ - first_ + 1));
    source.set_plain("frame_rate", fmt::format("{}", frame_rate_));
  } else {
    write_times();
    detail::YamlDocument timestamps;
    timestamps.set_string("file", "times.csv");
    timestamps.set_string("column", "time");
    timestamps.set_string("unit", "s");
    source.set("timestamps", timestamps);
  }
  source.set("calibration", calibration);
  if (!states_.empty()) source.set_string("truth_states", "truth_states.csv");
  if (!landmarks_.empty()) source.set_string("truth_landmarks", "truth_landmarks.csv");
  detail::YamlDocument scene(scene_yaml_);
  scene.set("source", source);
  if (!init_yaml_.empty()) scene.set("init", detail::YamlDocument(init_yaml_));
  TextFile(folder_.file("scene.yaml")).write(scene.text());
}

void RecordingWriter::finish() {
  if (first_ < 0) throw OutputError("the source gave no frame; there is nothing to record");
  folder_.write_with([this] {
    images_->wait();
    TextFile(folder_.file("calibration.yaml")).write(calibration_yaml(cameras_));
    TextFile(folder_.file("source.yaml")).write(scene_yaml_);
    write_truth();
    write_scene();
  });
  folder_.finish();
}

}  // namespace hypotrack::internal
