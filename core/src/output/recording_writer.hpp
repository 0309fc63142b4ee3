#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "hypotrack/camera.hpp"
#include "hypotrack/export.hpp"
#include "hypotrack/frame.hpp"
#include "hypotrack/scene.hpp"
#include "hypotrack/tables.hpp"
#include "output/image_writer.hpp"
#include "output/metrics/motion_speeds.hpp"

namespace hypotrack {

/// Writes a source of one camera or two as a folder that the `image_sequence` source reads:
/// left_000000.png, right_000000.png, masks (left_mask_000000.png) and depths
/// (left_depth_000000.png, 16 bits, tenths of a millimetre, up to 6.5535 m) where there are some,
/// calibration.yaml, truth_states.csv (with motion.json, its speeds) and truth_landmarks.csv where
/// the truth is known, scene.yaml, which tracks it, and source.yaml, the scene that was recorded.
/// The folder appears under its name when everything is in it.
class HYPOTRACK_API RecordingWriter {
 public:
  /// `scene_yaml` is the resolved scene (Session::resolved), whose source is replaced. Throws
  /// OutputError if the folder exists and is not empty or cannot be made, DataError unless there
  /// are one or two cameras.
  RecordingWriter(const Scene& scene, std::vector<Camera> cameras, double frame_rate,
                  std::string scene_yaml, std::filesystem::path directory);
  ~RecordingWriter();
  RecordingWriter(const RecordingWriter&) = delete;
  RecordingWriter& operator=(const RecordingWriter&) = delete;

  /// A frame without views leaves a gap in the numbering. Its images are compressed while the
  /// caller goes on and must not change any more. Throws OutputError if one could not be written.
  void add(const Frame& frame);
  /// Throws OutputError; also if no frame was added.
  void finish();
  bool empty() const { return first_ < 0; }
  /// Of the true states so far of frames with all models (motion.json); empty where they are
  /// unknown.
  std::vector<ModelSpeeds> motion() const;

 private:
  void write_image(const std::string& name, int index, cv::Mat image);
  void write_truth() const;
  void write_scene() const;

  const Scene* scene_;
  std::vector<Camera> cameras_;
  double frame_rate_;
  std::string scene_yaml_;
  std::filesystem::path directory_;
  std::filesystem::path part_;  ///< grows here; removed if never finished
  std::vector<StateRow> states_;
  std::vector<StateRow> seen_;  ///< of these, where no model is absent
  std::vector<LandmarkRow> landmarks_;
  std::set<std::string> names_;  ///< of the kinds of images: left, left_mask, ...
  int first_ = -1;
  int last_ = -1;
  std::optional<ImageWriter> images_{std::in_place};
};

/// A calibration in the project's own form (calibration.hpp, form 3): what load_calibration reads
/// back to the same cameras, bit for bit but for the last digit of rotations (it makes them
/// orthonormal).
HYPOTRACK_API std::string calibration_yaml(const std::vector<Camera>& cameras);

}  // namespace hypotrack
