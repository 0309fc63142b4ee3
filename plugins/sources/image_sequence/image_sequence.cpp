#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hypotrack/calibration.hpp"
#include "hypotrack/plugin.hpp"
#include "hypotrack/truth.hpp"
#include "pattern.hpp"
#include "read_image.hpp"

namespace hypotrack {

struct ImageSequenceParams {
  std::filesystem::path left;
  std::filesystem::path right;
  std::filesystem::path left_mask;
  std::filesystem::path right_mask;
  CalibrationSettings calibration;
  std::optional<int> start;
  int step = 1;
  std::optional<int> count;
  double frame_rate = 30;
  int bits = 16;
  TruthSettings truth;

  void visit(ParamVisitor& v) {
    v("left", left,
      {.help = "images of the first camera: left_%04d.png (numbers; gaps are reported), left_*.png "
               "(sorted, 9 before 10) or one file",
       .required = true});
    v("right", right, {.help = "images of the second camera; without it there is one view"});
    v("left_mask", left_mask, {.help = "foreground of the first camera: not zero is foreground"});
    v("right_mask", right_mask, {.help = "foreground of the second camera"});
    v("calibration", calibration, {.help = "the cameras"});
    v("start", start,
      {.help = "number (with %d) or position (with *) of the first frame; default: the first found",
       .min = 0});
    v("step", step, {.help = "take every step-th image", .min = 1, .max = 1000000});
    v("count", count, {.help = "number of frames; default: all", .min = 1, .max = 10000000});
    v("frame_rate", frame_rate,
      {.help = "images per second of the recording", .min = 1e-3, .max = 1e5, .unit = "1/s"});
    v("bits", bits, {.help = "significant bits of 16-bit images", .min = 8, .max = 16});
    truth.visit(v);
  }
};

/// Pictures on disk, one per view and frame. Tables of the answer (`truth_states`,
/// `truth_landmarks`) are CSV as described in hypotrack/tables.hpp; a row belongs to the image
/// whose number in the file name is the row's frame (with * instead of a number: the position in
/// the sorted list), unless `truth_offset` shifts it.
class ImageSequence : public Source {
 public:
  using Params = ImageSequenceParams;

  ImageSequence(const Params& params, PluginContext& context) : params_(params) {
    std::vector<std::filesystem::path> patterns = {params.left};
    if (!params.right.empty()) patterns.push_back(params.right);
    std::vector<std::filesystem::path> masks = patterns;
    masks[0] = params.left_mask;
    if (masks.size() > 1) masks[1] = params.right_mask;
    views_ = patterns.size();
    has_masks_ = !params.left_mask.empty();
    if (has_masks_ != !params.right_mask.empty() && views_ == 2) {
      throw ConfigError(
          fmt::format("{}: only one of left_mask and right_mask is given; expected "
                      "both or none",
                      context.config().where()));
    }
    if (has_masks_) patterns.insert(patterns.end(), masks.begin(), masks.end());
    Images images = find_images(patterns, {params.start, params.step, params.count});
    lists_ = std::move(images.views);
    first_ = images.first;
    cameras_ = load_calibration(params.calibration);
    if (cameras_.size() != views_) {
      throw DataError(fmt::format(
          "{}: holds {} cameras, the source has {} views (left{}); expected "
          "one camera per view",
          params.calibration.file.string(), cameras_.size(), views_, views_ == 2 ? ", right" : ""));
    }
    take_image_sizes();
    if (!params.truth.states.empty() || !params.truth.landmarks.empty()) {
      truth_ = TruthTables(params.truth, context.scene());
    }
  }

  const std::vector<Camera>& cameras() const override { return cameras_; }
  double frame_rate() const override { return params_.frame_rate / params_.step; }
  std::optional<int> frame_count() const override { return static_cast<int>(lists_[0].size()); }

  std::optional<Frame> next() override {
    if (next_ == lists_[0].size()) return std::nullopt;
    Frame frame = read(next_);
    ++next_;
    return frame;
  }

 private:
  Frame read(std::size_t index) const {
    Frame frame;
    frame.index = static_cast<int>(index);
    frame.time = frame.index / frame_rate();
    frame.truth = truth_.at(first_ + frame.index * params_.step);
    for (std::size_t v = 0; v < views_ && frame.problem.empty(); ++v) {
      frame.views.push_back(read_view(v, index, frame.problem));
    }
    if (!frame.problem.empty()) frame.views.clear();
    return frame;
  }

  View read_view(std::size_t v, std::size_t index, std::string& problem) const {
    const std::filesystem::path& file = lists_[v][index];
    ReadImage color = read_color(file, params_.bits);
    problem = color.problem;
    if (problem.empty()) problem = size_problem(file, color.image, cameras_[v]);
    View view{color.image, {}};
    if (has_masks_ && problem.empty()) {
      const std::filesystem::path& mask_file = lists_[views_ + v][index];
      ReadImage mask = read_mask(mask_file);
      problem = mask.problem;
      if (problem.empty()) problem = size_problem(mask_file, mask.image, cameras_[v]);
      view.mask = mask.image;
    }
    return view;
  }

  static std::string size_problem(const std::filesystem::path& file, const cv::Mat& image,
                                  const Camera& camera) {
    if (image.cols == camera.width && image.rows == camera.height) return {};
    return fmt::format("{}: is {}x{} pixels; expected {}x{} as its camera", file.string(),
                       image.cols, image.rows, camera.width, camera.height);
  }

  /// Compares the calibration with the first readable image of every view. A recording of another
  /// resolution is a mistake of the scene; a single frame of another size is damage.
  void take_image_sizes() {
    for (std::size_t v = 0; v < views_; ++v) {
      std::string first_problem;
      bool found = false;
      for (std::size_t i = 0; i < lists_[v].size() && !found; ++i) {
        const ReadImage read = read_color(lists_[v][i], params_.bits);
        if (first_problem.empty()) first_problem = read.problem;
        if (!read.problem.empty()) continue;
        fit_image_size(cameras_[v], read.image.cols, read.image.rows, lists_[v][i].string());
        found = true;
      }
      if (!found) throw DataError(fmt::format("no image can be read: {}", first_problem));
    }
  }

  Params params_;
  std::size_t views_ = 0;
  bool has_masks_ = false;
  std::vector<ImageList> lists_;  ///< images of every view, then masks of every view
  int first_ = 0;                 ///< number of the first image
  std::vector<Camera> cameras_;
  TruthTables truth_;
  std::size_t next_ = 0;
};

}  // namespace hypotrack

HYPOTRACK_PLUGIN(hypotrack::ImageSequence, "Images on disk, one file per view and frame", "")
