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

#include "hypotrack/api/image_file.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "hypotrack/plugin/truth.hpp"
#include "layers.hpp"
#include "timed_images.hpp"

namespace hypotrack {

constexpr double kUsualRate = 30;  // frames per second

/// Reads pictures from disk, one per view and frame: colour, depth or both. Truth tables
/// (`truth_states`, `truth_landmarks`) are CSV as described in hypotrack/api/tables.hpp. A row's
/// frame is the number in the image's file name (with * instead of a number: the position in the
/// sorted list), unless `truth_offset` shifts it. A frame's time is its number over the frame rate,
/// or that of its time stamp since the first frame's.
class ImageSequence : public Source {
 public:
  using Params = ImageSequenceParams;

  ImageSequence(const Params& params, PluginContext& context)
      : params_(params), layers_(layers_of(params)) {
    check_patterns(params, context.config().where());
    std::vector<std::filesystem::path> patterns;
    for (const Layer& layer : layers_) {
      patterns.push_back(layer.pattern);
      views_ = std::max(views_, layer.view + 1);
    }
    if (params.layout) views_ = 2;
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
    take_times(std::move(found.stamps));
    cameras_ = load_calibration(params.calibration, first_image(0).size, &notes_);
    note_pictures();
    if (cameras_.size() != views_) {
      throw DataError(
          fmt::format("{}: holds {} cameras, the source has {} views (left{}); expected "
                      "one camera per view, which `cameras` (calibration) chooses",
                      params.calibration.file.string(), cameras_.size(), views_,
                      params.layout ? " and its layout"
                      : views_ == 2 ? ", right"
                                    : ""));
    }
    for (std::size_t i = 0; i < layers_.size(); ++i) take_image_size(i);
    if (!params.truth.states.empty() || !params.truth.landmarks.empty()) {
      truth_ = TruthTables(params.truth, context.scene());
      truth_.expect_some(first_, params.step, do_frame_count());
    }
  }

 private:
  const std::vector<Camera>& do_cameras() const override { return cameras_; }
  std::vector<std::string> do_notes() const override { return notes_; }
  double do_frame_rate() const override { return rate_; }
  std::optional<int> do_frame_count() const override { return static_cast<int>(lists_[0].size()); }

  std::optional<Frame> do_next() override {
    if (decoded_.empty()) decode();
    if (decoded_.empty()) return std::nullopt;
    Decoded next = std::move(decoded_.front());
    decoded_.pop_front();
    if (next.error) std::rethrow_exception(next.error);
    return std::move(next.frame);
  }

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
    frame.time =
        stamps_.empty() ? frame.index / rate_ : seconds_between(stamps_.front(), stamps_[index]);
    if (!stamps_.empty()) frame.stamp = stamps_[index];
    frame.truth = truth_.at(first_ + frame.index * params_.step);
    frame.views.resize(views_);
    std::vector<Pictures> pictures(layers_.size());
    tbb::parallel_for(std::size_t{0}, layers_.size(),
                      [&](std::size_t i) { pictures[i] = read_pictures(i, index); });
    for (std::size_t i = 0; i < layers_.size() && frame.problem.empty(); ++i) {
      frame.problem = pictures[i].problem;
      for (std::size_t v = 0; v < pictures[i].views.size(); ++v)
        image_of(frame.views[layers_[i].view + v], layers_[i].content) = pictures[i].views[v];
    }
    if (!frame.problem.empty()) frame.views.clear();
    return frame;
  }

  /// The pictures that a file of a layer has: one, or with a layout those of both views.
  struct Pictures {
    std::vector<cv::Mat> views;
    std::string problem;
  };
  Pictures read_pictures(std::size_t layer, std::size_t index) const {
    ReadImage read = read_layer(layer, index);
    Pictures out{{}, std::move(read.problem)};
    if (!out.problem.empty()) return out;
    if (params_.layout) {
      const auto views = split_views(*params_.layout, read.image);
      out.views.assign(views.begin(), views.end());
    } else {
      out.views = {read.image};
    }
    for (std::size_t v = 0; v < out.views.size() && out.problem.empty(); ++v)
      out.problem =
          size_problem(lists_[layer][index], out.views[v], cameras_[layers_[layer].view + v]);
    return out;
  }

  /// Notes how the pictures are read.
  void note_pictures() {
    for (std::size_t i = 0; i < layers_.size(); ++i) {
      notes_.push_back(orientation_note(lists_[i]));
      if (layers_[i].content == Content::mask) notes_.push_back(mask_note(lists_[i]));
      if (layers_[i].content != Content::color) continue;
      notes_.push_back(contents_note(lists_[i]));
      notes_.push_back(bits_note(lists_[i], params_.bits));
    }
    if (!params_.timestamps.given()) notes_.push_back(note_on_names(lists_[0]));
    std::erase(notes_, "");
  }

  void take_times(std::vector<Stamp> stamps) {
    if (stamps.empty()) return;
    const TimestampSettings& settings = params_.timestamps;
    rate_ = rate_of(stamps, *settings.unit,
                    (settings.file.empty() ? layers_[0].pattern : settings.file).string());
    stamps_ = std::move(stamps);
  }

  ReadImage read_layer(std::size_t layer, std::size_t index) const {
    const std::filesystem::path& file = lists_[layer][index];
    switch (layers_[layer].content) {
      case Content::color:
        return read_color(file, params_.bits.value_or(16));
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
    for (std::size_t v = 0; v < (params_.layout ? 2 : 1); ++v)
      fit_image_size(cameras_[layers_[layer].view + v], first.size.width, first.size.height,
                     first.file.string());
  }

  /// The first image of a layer that can be read, and the size of its view or views.
  struct FirstImage {
    std::filesystem::path file;
    ImageSize size;
  };
  FirstImage first_image(std::size_t layer) const {
    std::string first_problem;
    for (std::size_t i = 0; i < lists_[layer].size(); ++i) {
      const ReadImage read = read_layer(layer, i);
      if (first_problem.empty()) first_problem = read.problem;
      if (!read.problem.empty()) continue;
      const std::filesystem::path& file = lists_[layer][i];
      const int width = read.image.cols, height = read.image.rows;
      return {file, params_.layout ? view_size(*params_.layout, width, height, file.string())
                                   : ImageSize{width, height}};
    }
    throw DataError(fmt::format("no image can be read: {}", first_problem));
  }

  Params params_;
  std::vector<Layer> layers_;
  std::size_t views_ = 1;
  std::vector<ImageList> lists_;  ///< images of every layer
  int first_ = 0;                 ///< number of the first image
  double rate_ = kUsualRate;      ///< frames per second
  std::vector<Stamp> stamps_;     ///< of the frames; empty: constant rate
  std::vector<Camera> cameras_;
  std::vector<std::string> notes_;  ///< on the calibration
  TruthTables truth_;
  std::size_t next_ = 0;         ///< frame that is decoded next
  std::deque<Decoded> decoded_;  ///< frames before it that were not asked for yet
};

}  // namespace hypotrack

HYPOTRACK_PLUGIN(hypotrack::ImageSequence,
                 "Images on disk, one file per view and frame: colour, depth or both", "")
