#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hypotrack/api/calibration.hpp"
#include "hypotrack/api/image_file.hpp"
#include "hypotrack/api/timeline.hpp"
#include "hypotrack/plugin/numbers.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "hypotrack/plugin/truth.hpp"
#include "image_list.hpp"

namespace hypotrack::rgbd {
namespace {

struct RgbdParams {
  std::filesystem::path folder;
  std::string color_list = "rgb.txt";  // not paths: they are relative to `folder`
  std::string depth_list = "depth.txt";
  double max_difference = 0.02;
  double depth_factor = 5000;
  std::optional<int> bits;
  CalibrationSettings calibration;
  int start = 0;
  std::optional<int> count;
  std::optional<double> frame_rate;
  TruthSettings truth;

  void visit(ParamVisitor& v) {
    v("folder", folder,
      {.help = "folder of the recording, with the two lists in it", .required = true});
    v("color_list", color_list,
      {.help = "list of the colour images in that folder: a time in seconds and a file per line"});
    v("depth_list", depth_list,
      {.help = "list of the depth images: 16-bit PNG, registered to the colour, 0: not measured"});
    v("max_difference_s", max_difference,
      {.help = "a colour and a depth image farther apart in time are no frame",
       .min = 0,
       .max = 10,
       .unit = "s"});
    v("depth_factor", depth_factor,
      {.help = "depth units per metre: 5000 in the TUM recordings, 1000 for millimetres",
       .min = 1,
       .max = 1e7,
       .unit = "1/m"});
    v("bits", bits,
      {.help = "significant bits of 16-bit colour images; default: 16", .min = 8, .max = 16});
    v("calibration", calibration,
      {.help = "the one camera that both images belong to", .required = true});
    v("start", start,
      {.help = "position of the first frame in the colour list", .min = 0, .max = 1e7});
    v("count", count, {.help = "number of frames; default: all", .min = 1, .max = 1e7});
    v("frame_rate", frame_rate,
      {.help = "of the results' video; default: that of the times in the colour list",
       .min = 1e-3,
       .max = 1e5,
       .unit = "1/s"});
    truth.visit(v);
  }
};

/// Returns the frames per second of a list: one over the median time between two images, which gaps
/// do not change. A single image gets 30.
double rate_of(const std::vector<TimedImage>& images) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < images.size(); ++i) {
    steps.push_back(images[i].time - images[i - 1].time);
  }
  if (steps.empty()) return 30;
  return std::clamp(1 / upper_median(std::move(steps)), 1e-3, 1e5);
}

/// Reads recordings of one colour and depth camera in the layout of the TUM RGB-D benchmark (Sturm,
/// Engelhard, Endres, Burgard and Cremers, "A benchmark for the evaluation of RGB-D SLAM systems",
/// IROS 2012). A frame is a colour image; its depth image is the nearest in time, if each is the
/// other's nearest. A colour image without one is a frame with a problem. The camera's own motion
/// (groundtruth.txt) is not read: the camera is the world. Rows of the truth tables refer to
/// positions in the colour list.
class Rgbd final : public Source {
 public:
  using Params = RgbdParams;

  Rgbd(const Params& params, PluginContext& context)
      : params_(params),
        color_(read_image_list(params.folder / params.color_list)),
        depth_(read_image_list(params.folder / params.depth_list)),
        partners_(associate(color_, depth_, params.max_difference)),
        next_(static_cast<std::size_t>(params.start)) {
    if (next_ >= color_.size()) {
      throw DataError(fmt::format("{}: lists {} images; expected more than `start: {}`",
                                  list_name(params.color_list), color_.size(), params.start));
    }
    end_ = color_.size();
    if (params.count) end_ = std::min(end_, next_ + static_cast<std::size_t>(*params.count));
    require_a_pair();
    cameras_ = load_calibration(params.calibration, {}, &notes_);
    if (cameras_.size() != 1) {
      throw DataError(
          fmt::format("{}: holds {} cameras; expected one: the colour camera, which "
                      "the depth is registered to",
                      params.calibration.file.string(), cameras_.size()));
    }
    note_pictures();
    take_image_size([&](std::size_t i) { return color_[i].file; },
                    [&](const auto& file) { return read_color(file, bits()); });
    take_image_size([&](std::size_t i) { return depth_file(i); },
                    [&](const auto& file) { return read_depth(file, unit()); });
    if (!params.truth.states.empty() || !params.truth.landmarks.empty()) {
      truth_ = TruthTables(params.truth, context.scene());
      truth_.expect_some(params.start, 1, do_frame_count());
    }
  }

 private:
  const std::vector<Camera>& do_cameras() const override { return cameras_; }
  std::vector<std::string> do_notes() const override { return notes_; }
  double do_frame_rate() const override { return params_.frame_rate.value_or(rate_of(color_)); }
  std::optional<int> do_frame_count() const override {
    return static_cast<int>(end_) - params_.start;
  }

  std::optional<Frame> do_next() override {
    if (next_ == end_) return std::nullopt;
    const std::size_t i = next_++;
    Frame frame;
    frame.index = static_cast<int>(i) - params_.start;
    const std::int64_t first = color_[static_cast<std::size_t>(params_.start)].stamp;
    frame.time = 1e-9 * static_cast<double>(color_[i].stamp - first);
    frame.stamp = color_[i].stamp;
    frame.truth = truth_.at(static_cast<int>(i));
    View view;
    frame.problem = read(i, view);
    if (frame.problem.empty()) frame.views.push_back(std::move(view));
    return frame;
  }

  std::string list_name(const std::string& list) const { return (params_.folder / list).string(); }
  int bits() const { return params_.bits.value_or(16); }
  double unit() const { return 1 / params_.depth_factor; }
  const std::filesystem::path& depth_file(std::size_t i) const {
    return depth_[*partners_[i]].file;
  }

  /// Notes how the pictures are read.
  void note_pictures() {
    std::vector<std::filesystem::path> colors, depths;
    for (std::size_t i = next_; i < end_; ++i) {
      if (!partners_[i]) continue;
      colors.push_back(color_[i].file);
      depths.push_back(depth_file(i));
    }
    for (std::string note : {orientation_note(colors), orientation_note(depths),
                             contents_note(colors), bits_note(colors, params_.bits)})
      if (!note.empty()) notes_.push_back(std::move(note));
  }

  /// Reads the view. Returns a description of the problem, if any.
  std::string read(std::size_t i, View& view) const {
    if (!partners_[i]) return unmatched(i);
    ReadImage color = read_color(color_[i].file, bits());
    if (color.problem.empty()) {
      color.problem = size_problem(color_[i].file, color.image, cameras_[0]);
    }
    if (!color.problem.empty()) return color.problem;
    ReadImage depth = read_depth(depth_file(i), unit());
    if (depth.problem.empty()) {
      depth.problem = size_problem(depth_file(i), depth.image, cameras_[0]);
    }
    view.color = color.image;
    view.depth = depth.image;
    return depth.problem;
  }

  std::string unmatched(std::size_t i) const {
    const TimedImage& other = depth_[nearest_in_time(stamps_of(depth_), color_[i].stamp)];
    const double apart = 1e-9 * static_cast<double>(std::abs(other.stamp - color_[i].stamp));
    return fmt::format(
        "{}: no depth image belongs to it: the nearest in time, {}, is {:.3g} s away{}",
        color_[i].file.string(), other.file.filename().string(), apart,
        apart <= params_.max_difference
            ? " and nearer to another colour image"
            : fmt::format("; expected {:.3g} s or less", params_.max_difference));
  }

  void require_a_pair() const {
    for (std::size_t i = next_; i < end_; ++i) {
      if (partners_[i]) return;
    }
    throw DataError(
        fmt::format("{} and {} have no two images within {} s of each other; the first: {}",
                    list_name(params_.color_list), list_name(params_.depth_list),
                    params_.max_difference, unmatched(next_)));
  }

  /// Compares the calibration with the first readable image of a frame. Another resolution in the
  /// whole recording is a mistake of the scene; a single frame of another size is damaged.
  template <class FileOf, class Read>
  void take_image_size(const FileOf& file_of, const Read& read_image) {
    std::string first_problem;
    for (std::size_t i = next_; i < end_; ++i) {
      if (!partners_[i]) continue;
      const ReadImage image = read_image(file_of(i));
      if (first_problem.empty()) first_problem = image.problem;
      if (!image.problem.empty()) continue;
      fit_image_size(cameras_[0], image.image.cols, image.image.rows, file_of(i).string());
      return;
    }
    throw DataError(fmt::format("no image can be read: {}", first_problem));
  }

  Params params_;
  std::vector<TimedImage> color_, depth_;
  std::vector<std::optional<std::size_t>> partners_;  ///< of every colour image: index in depth_
  std::size_t next_ = 0, end_ = 0;
  std::vector<Camera> cameras_;
  std::vector<std::string> notes_;  ///< on the calibration
  TruthTables truth_;
};

}  // namespace
}  // namespace hypotrack::rgbd

HYPOTRACK_PLUGIN(hypotrack::rgbd::Rgbd,
                 "colour and depth of one camera in the layout of the TUM RGB-D benchmark", "depth")
