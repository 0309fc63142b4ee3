#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <deque>
#include <exception>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hypotrack/calibration.hpp"
#include "hypotrack/image_file.hpp"
#include "hypotrack/plugin.hpp"
#include "hypotrack/truth.hpp"
#include "timed_images.hpp"

namespace hypotrack {

constexpr double kUsualRate = 30;  // frames per second

struct ImageSequenceParams {
  std::filesystem::path left;
  std::filesystem::path right;
  std::filesystem::path left_mask;
  std::filesystem::path right_mask;
  std::filesystem::path left_depth;
  std::filesystem::path right_depth;
  double depth_unit = kMillimetre;
  CalibrationSettings calibration;
  std::optional<int> start;
  int step = 1;
  std::optional<int> count;
  std::optional<double> frame_rate;
  TimestampSettings timestamps;
  int bits = 16;
  TruthSettings truth;

  void visit(ParamVisitor& v) {
    v("left", left,
      {.help = "images of the first camera: left_%04d.png (numbers; gaps are reported), left_*.png "
               "(sorted, 9 before 10) or one file; not needed where there is left_depth"});
    v("right", right,
      {.help = "images of the second camera; without it and right_depth there is one view"});
    v("left_mask", left_mask, {.help = "foreground of the first camera: not zero is foreground"});
    v("right_mask", right_mask, {.help = "foreground of the second camera"});
    v("left_depth", left_depth,
      {.help = "depth along the axis of the first camera: 16-bit PNG, 0 is not measured"});
    v("right_depth", right_depth, {.help = "depth of the second camera"});
    v("depth_units_mm", depth_unit,
      {.help = "depth that one unit of left_depth and right_depth means",
       .min = 1e-4,
       .max = 1e3,
       .unit = "mm",
       .to_si = kMillimetre});
    v("calibration", calibration, {.help = "the cameras", .required = true});
    v("start", start,
      {.help = "number (with %d) or position (with *) of the first frame; default: the first found",
       .min = 0});
    v("step", step, {.help = "take every step-th image", .min = 1, .max = 1000000});
    v("count", count, {.help = "number of frames; default: all", .min = 1, .max = 10000000});
    v("frame_rate", frame_rate,
      {.help = "images per second of the recording; default: 30, or as the time stamps have it",
       .min = 1e-3,
       .max = 1e5,
       .unit = "1/s"});
    v("timestamps", timestamps,
      {.help = "when images were taken, if not at a constant rate: with them a gap is as long as "
               "it was"});
    v("bits", bits, {.help = "significant bits of 16-bit images", .min = 8, .max = 16});
    truth.visit(v);
  }
};

enum class Content { color, mask, depth };

/// One of the pictures that make up a frame.
struct Layer {
  std::size_t view;
  Content content;
  std::filesystem::path pattern;
};

/// Returns the layers that are given. Throws ConfigError, naming `where`, if they make no views.
std::vector<Layer> layers_of(const ImageSequenceParams& params, const std::string& where) {
  const bool second = !params.right.empty() || !params.right_depth.empty();
  if (params.left.empty() && params.left_depth.empty()) {
    throw ConfigError(where +
                      ": neither left nor left_depth is given; expected the images of the "
                      "first camera in `left` (colour), `left_depth` or both");
  }
  if (second && params.left_mask.empty() != params.right_mask.empty()) {
    throw ConfigError(where +
                      ": only one of left_mask and right_mask is given; expected both or none");
  }
  if (!second && !params.right_mask.empty()) {
    throw ConfigError(where +
                      ": right_mask is given without images of the second camera; expected "
                      "`right` or `right_depth`, too");
  }
  std::vector<Layer> layers;
  const auto add = [&](std::size_t view, Content content, const std::filesystem::path& pattern) {
    if (!pattern.empty()) layers.push_back({view, content, pattern});
  };
  add(0, Content::color, params.left);
  add(1, Content::color, params.right);
  add(0, Content::mask, params.left_mask);
  add(1, Content::mask, params.right_mask);
  add(0, Content::depth, params.left_depth);
  add(1, Content::depth, params.right_depth);
  return layers;
}

/// Reads pictures from disk, one per view and frame: colour, depth or both. Truth tables
/// (`truth_states`, `truth_landmarks`) are CSV as described in hypotrack/tables.hpp. A row's frame
/// is the number in the image's file name (with * instead of a number: the position in the sorted
/// list), unless `truth_offset` shifts it. A frame's time is its number over the frame rate, or
/// that of its time stamp since the first frame's.
class ImageSequence : public Source {
 public:
  using Params = ImageSequenceParams;

  ImageSequence(const Params& params, PluginContext& context)
      : params_(params), layers_(layers_of(params, context.config().where())) {
    std::vector<std::filesystem::path> patterns;
    for (const Layer& layer : layers_) {
      patterns.push_back(layer.pattern);
      views_ = std::max(views_, layer.view + 1);
    }
    check(params.timestamps, context.config().where());
    if (params.timestamps.given() && params.frame_rate) {
      throw ConfigError(context.config().where_key("frame_rate") +
                        ": frame_rate is given together with timestamps; expected one of the two");
    }
    TimedImages found =
        find_timed_images(patterns, {params.start, params.step, params.count}, params.timestamps);
    lists_ = std::move(found.images.views);
    first_ = found.images.first;
    rate_ = params.frame_rate.value_or(kUsualRate) / params.step;
    take_times(found.stamps);
    cameras_ = load_calibration(params.calibration, first_image(0).size, &notes_);
    if (cameras_.size() != views_) {
      throw DataError(fmt::format(
          "{}: holds {} cameras, the source has {} views (left{}); expected "
          "one camera per view, which `cameras` (calibration) chooses",
          params.calibration.file.string(), cameras_.size(), views_, views_ == 2 ? ", right" : ""));
    }
    for (std::size_t i = 0; i < layers_.size(); ++i) take_image_size(i);
    if (!params.truth.states.empty() || !params.truth.landmarks.empty()) {
      truth_ = TruthTables(params.truth, context.scene());
      truth_.expect_some(first_, params.step, frame_count());
    }
  }

  const std::vector<Camera>& cameras() const override { return cameras_; }
  std::vector<std::string> notes() const override { return notes_; }
  double frame_rate() const override { return rate_; }
  std::optional<int> frame_count() const override { return static_cast<int>(lists_[0].size()); }

  std::optional<Frame> next() override {
    if (decoded_.empty()) decode();
    if (decoded_.empty()) return std::nullopt;
    Decoded next = std::move(decoded_.front());
    decoded_.pop_front();
    if (next.error) std::rethrow_exception(next.error);
    return std::move(next.frame);
  }

 private:
  struct Decoded {
    Frame frame = {};
    std::exception_ptr error = nullptr;
  };

  /// Decodes the next frames at the same time: as many as half of the threads.
  void decode() {
    constexpr int kMost = 4;
    const auto at_once =
        static_cast<std::size_t>(std::clamp(tbb::this_task_arena::max_concurrency() / 2, 1, kMost));
    const std::size_t count = std::min(at_once, lists_[0].size() - next_);
    decoded_.resize(count);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
      try {
        decoded_[i].frame = read(next_ + i);
      } catch (...) {
        decoded_[i].error = std::current_exception();
      }
    });
    next_ += count;
  }

  Frame read(std::size_t index) const {
    Frame frame;
    frame.index = static_cast<int>(index);
    frame.time = times_.empty() ? frame.index / rate_ : times_[index];
    frame.truth = truth_.at(first_ + frame.index * params_.step);
    frame.views.resize(views_);
    std::vector<ReadImage> pictures(layers_.size());
    tbb::parallel_for(std::size_t{0}, layers_.size(), [&](std::size_t i) {
      pictures[i] = read_layer(i, index);
      if (pictures[i].problem.empty())
        pictures[i].problem =
            size_problem(lists_[i][index], pictures[i].image, cameras_[layers_[i].view]);
    });
    for (std::size_t i = 0; i < layers_.size() && frame.problem.empty(); ++i) {
      frame.problem = pictures[i].problem;
      image_of(frame.views[layers_[i].view], layers_[i].content) = pictures[i].image;
    }
    if (!frame.problem.empty()) frame.views.clear();
    return frame;
  }

  void take_times(const std::vector<Stamp>& stamps) {
    if (stamps.empty()) return;
    const TimestampSettings& settings = params_.timestamps;
    rate_ = rate_of(stamps, *settings.unit,
                    (settings.file.empty() ? layers_[0].pattern : settings.file).string());
    for (const Stamp stamp : stamps) times_.push_back(seconds_between(stamps.front(), stamp));
  }

  ReadImage read_layer(std::size_t layer, std::size_t index) const {
    const std::filesystem::path& file = lists_[layer][index];
    switch (layers_[layer].content) {
      case Content::color:
        return read_color(file, params_.bits);
      case Content::mask:
        return read_mask(file);
      case Content::depth:
        return read_depth(file, params_.depth_unit);
    }
    return {};
  }

  static cv::Mat& image_of(View& view, Content content) {
    switch (content) {
      case Content::mask:
        return view.mask;
      case Content::depth:
        return view.depth;
      default:
        return view.color;
    }
  }

  /// Compares the calibration with the first readable image of a layer. Another resolution in the
  /// whole recording is a mistake of the scene; a single frame of another size is damaged.
  void take_image_size(std::size_t layer) {
    if (layers_[layer].content == Content::mask) return;
    const FirstImage first = first_image(layer);
    fit_image_size(cameras_[layers_[layer].view], first.size.width, first.size.height,
                   first.file.string());
  }

  /// The first image of a layer that can be read.
  struct FirstImage {
    std::filesystem::path file;
    ImageSize size;
  };
  FirstImage first_image(std::size_t layer) const {
    std::string first_problem;
    for (std::size_t i = 0; i < lists_[layer].size(); ++i) {
      const ReadImage read = read_layer(layer, i);
      if (first_problem.empty()) first_problem = read.problem;
      if (read.problem.empty()) return {lists_[layer][i], {read.image.cols, read.image.rows}};
    }
    throw DataError(fmt::format("no image can be read: {}", first_problem));
  }

  Params params_;
  std::vector<Layer> layers_;
  std::size_t views_ = 1;
  std::vector<ImageList> lists_;  ///< images of every layer
  int first_ = 0;                 ///< number of the first image
  double rate_ = kUsualRate;      ///< frames per second
  std::vector<double> times_;     ///< of the frames, seconds since the first; empty: constant rate
  std::vector<Camera> cameras_;
  std::vector<std::string> notes_;  ///< on the calibration
  TruthTables truth_;
  std::size_t next_ = 0;         ///< frame that is decoded next
  std::deque<Decoded> decoded_;  ///< frames before it that were not asked for yet
};

}  // namespace hypotrack

HYPOTRACK_PLUGIN(hypotrack::ImageSequence,
                 "Images on disk, one file per view and frame: colour, depth or both", "")
