#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/api/tables.hpp"
#include "output/metrics/motion_speeds.hpp"
#include "output/recording/image_writer.hpp"
#include "output/recording/recording_folder.hpp"
#include "session/scene_file.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Format of a recording's colour pictures: lossless, JPEG of quality 95, or Netpbm, uncompressed
/// as masks and depths are then, too.
enum class PictureFormat { png, jpeg, ppm };

/// Writes the frames of one or two cameras as a folder that the `image_sequence` source reads.
///
/// Images: left_000000.png, right_000000.png (or .jpg, .ppm), masks (left_mask_000000.png) and
/// depths (left_depth_000000.png, 16 bits, tenths of a millimetre, up to 6.5535 m) where there are
/// some. Also times.csv if frames have stamps or are not evenly spaced in time; calibration.yaml;
/// scene.yaml, which tracks the recording; source.yaml, the recorded scene; start_NAME, files of
/// its start. If the truth is known: truth_states.csv, truth_landmarks.csv and motion.json with the
/// speeds. The folder gets its name when it is complete.
class RecordingWriter {
 public:
  /// `scene_yaml` is the resolved scene (OpenedScene::resolved), whose source is replaced. Throws
  /// OutputError if the folder exists and is not empty or cannot be made, DataError unless there
  /// are one or two cameras. `threads`: of ImageWriter.
  RecordingWriter(const Scene& scene, std::vector<Camera> cameras, double frame_rate,
                  std::string scene_yaml, std::filesystem::path directory,
                  PictureFormat format = PictureFormat::png, int threads = 0);
  RecordingWriter(const RecordingWriter&) = delete;
  RecordingWriter& operator=(const RecordingWriter&) = delete;

  /// Copies the files of the scene's start, so that scene.yaml runs from anywhere. Throws
  /// OutputError.
  void copy_start(const InitSettings& init);
  /// Adds a frame; one without views leaves a gap in the numbering. Its images must not change
  /// afterwards: they are compressed while the caller goes on. Throws OutputError if one could not
  /// be written.
  void add(const Frame& frame);
  /// Completes the folder. Throws OutputError, also if no frame was added.
  void finish();
  /// Completes the folder with the frames before the first whose images are not whole, after add()
  /// or finish() threw OutputError. Returns their number; without any it leaves nothing. Throws
  /// OutputError, and leaves the images in the unfinished folder then.
  int finish_after_error();
  bool empty() const { return first_ < 0; }
  /// Returns where the complete folder is or will be: another place than wanted if the folder above
  /// it was renamed.
  std::filesystem::path place() const { return folder_.place(); }
  /// Returns the true speeds so far (motion.json), over frames with all models; empty if unknown.
  std::vector<ModelSpeeds> motion() const;

 private:
  /// Completes the folder with as many of its frames as there is room for. Returns their number.
  int finish_where_it_fits();
  /// Drops the last frame that has images, and those after it.
  void drop_last();
  void write_image(const std::string& name, int index, cv::Mat image,
                   const char* extension = ".png");
  void add_pictures(const Frame& frame);
  void note_time(const Frame& frame);
  bool evenly_spaced() const;
  void write_times() const;
  void write_truth() const;
  void write_scene() const;

  const Scene* scene_;
  std::vector<Camera> cameras_;
  double frame_rate_;
  std::string scene_yaml_;
  std::string init_yaml_;  ///< start of scene.yaml; empty: as in `scene_yaml_`
  PictureFormat format_;
  RecordingFolder folder_;
  /// Frames with images, and the files of each.
  std::vector<std::pair<int, std::vector<std::filesystem::path>>> frames_;
  std::vector<StateRow> states_;
  std::vector<StateRow> seen_;  ///< the states in which no model is absent
  std::vector<LandmarkRow> landmarks_;
  std::map<std::string, std::string> extensions_;  ///< of kinds of images: left, left_mask, ...
  int first_ = -1;
  int last_ = -1;
  int first_image_ = -1;
  int last_image_ = -1;
  std::vector<double> times_;         ///< of the frames from first_ to last_
  std::vector<std::int64_t> stamps_;  ///< of the same frames
  bool stamped_ = true;               ///< all have Frame::stamp, and it grows
  int threads_;
  std::optional<ImageWriter> images_;  ///< ends before the folder
};

/// Returns a calibration in the project's own form (calibration.hpp, form 3). load_calibration()
/// reads the same cameras back, exactly except for the last digit of rotations (it orthonormalises
/// them).
std::string calibration_yaml(const std::vector<Camera>& cameras);

}  // namespace internal
}  // namespace hypotrack
