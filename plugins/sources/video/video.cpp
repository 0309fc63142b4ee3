#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hypotrack/calibration.hpp"
#include "hypotrack/plugin.hpp"
#include "hypotrack/stereo_layout.hpp"
#include "hypotrack/truth.hpp"
#include "reader.hpp"

namespace hypotrack {

struct VideoParams {
  std::filesystem::path left;
  std::filesystem::path right;
  std::filesystem::path side_by_side;
  std::optional<StereoLayout> layout;
  CalibrationSettings calibration;
  int offset = 0;
  int start = 0;
  int step = 1;
  std::optional<int> count;
  std::optional<double> frame_rate;
  TruthSettings truth;

  void visit(ParamVisitor& v) {
    v("left", left, {.help = "video of the first camera"});
    v("right", right, {.help = "video of the second camera; without it there is one view"});
    v("side_by_side", side_by_side,
      {.help = "one video with the first camera in the left half and the second in the right half, "
               "instead of left and right"});
    v("layout", layout,
      {.help = "how `left` holds both views, instead of `right`: the first camera in its left half "
               "(side_by_side) or its upper half (top_bottom)"});
    v("calibration", calibration, {.help = "the cameras", .required = true});
    v("offset", offset,
      {.help = "frame of `right` that belongs to frame 0 of `left`; negative: `right` started "
               "later",
       .min = -1000000,
       .max = 1000000});
    v("start", start, {.help = "frames of `left` to leave out first", .min = 0, .max = 1000000000});
    v("step", step, {.help = "take every step-th frame", .min = 1, .max = 1000000});
    v("count", count, {.help = "number of frames; default: all", .min = 1});
    v("frame_rate", frame_rate,
      {.help = "frames per second; default: what the file says, or 30",
       .min = 1e-3,
       .max = 1e5,
       .unit = "1/s"});
    truth.visit(v);
  }
};

/// Tolerated difference of the two files' frame rates, which are rounded or means.
constexpr double kSameRate = 0.01;

/// Reads two synchronous videos, or one with both views side by side. Ends when either ends. Truth
/// tables (`truth_states`, `truth_landmarks`) are CSV as described in hypotrack/tables.hpp. Their
/// frames are those of the first video, unless `truth_offset` shifts them.
class Video : public Source {
 public:
  using Params = VideoParams;

  Video(const Params& params, PluginContext& context) : params_(params) {
    open(context.config().where());
    const std::size_t views = split_ ? 2 : readers_.size();
    cameras_ = load_calibration(params.calibration, size_of_view(0), &notes_);
    if (cameras_.size() != views) {
      throw DataError(
          fmt::format("{}: holds {} cameras, the source has {} views; expected one "
                      "camera per view, which `cameras` (calibration) chooses",
                      params.calibration.file.string(), cameras_.size(), views));
    }
    for (std::size_t v = 0; v < views; ++v) {
      const ImageSize size = size_of_view(v);
      fit_image_size(cameras_[v], size.width, size.height, files_[split_ ? 0 : v].string());
    }
    // Advance both videos to the first common frame that is wanted.
    first_ = std::max(params.start, -params.offset);
    if (!params.truth.states.empty() || !params.truth.landmarks.empty()) {
      truth_ = TruthTables(params.truth, context.scene());
      truth_.expect_some(first_, params.step, frame_count());
    }
    skip(0, first_);
    if (readers_.size() == 2) skip(1, first_ + params.offset);
  }

  const std::vector<Camera>& cameras() const override { return cameras_; }
  std::vector<std::string> notes() const override { return notes_; }

  double frame_rate() const override {
    const double recorded = readers_[0].frame_rate() > 0 ? readers_[0].frame_rate() : 30;
    return params_.frame_rate.value_or(recorded) / params_.step;
  }

  std::optional<int> frame_count() const override {
    std::optional<int> count = params_.count;
    for (std::size_t i = 0; i < readers_.size(); ++i) {
      if (readers_[i].frame_count() == 0) return std::nullopt;
      const int skipped = first_ + (i == 1 ? params_.offset : 0);
      const int rest = std::max(0, readers_[i].frame_count() - skipped);
      const int frames = (rest + params_.step - 1) / params_.step;
      count = std::min(count.value_or(frames), frames);
    }
    return count;
  }

  std::vector<std::string> statistics() const override {
    std::vector<std::string> lines;
    for (const VideoReader& reader : readers_) {
      if (std::string problem = reader.problem_of_end(); !problem.empty())
        lines.push_back(std::move(problem));
    }
    return lines;
  }

  std::optional<Frame> next() override {
    if (params_.count && index_ == *params_.count) return std::nullopt;
    if (index_ > 0) {
      for (std::size_t i = 0; i < readers_.size(); ++i) skip(i, params_.step - 1);
    }
    Frame frame;
    std::vector<cv::Mat> images;
    for (std::size_t i = 0; i < readers_.size(); ++i) {
      cv::Mat image;
      const VideoReader::Result result = readers_[i].next(image);
      if (result == VideoReader::Result::end && index_ > 0) return std::nullopt;
      if (result == VideoReader::Result::end) {
        throw DataError(fmt::format("{}: ends before frame {}, the first that start{} for",
                                    files_[i].string(), first_ + (i == 1 ? params_.offset : 0),
                                    readers_.size() == 2 ? " and offset ask" : " asks"));
      }
      if (result == VideoReader::Result::damaged) {
        frame.problem = fmt::format("{}: a frame cannot be decoded", files_[i].string());
      }
      images.push_back(image);
    }
    frame.index = index_++;
    frame.time = frame.index / frame_rate();
    frame.truth = truth_.at(first_ + frame.index * params_.step);
    if (frame.problem.empty()) fill_views(frame, images);
    return frame;
  }

 private:
  ImageSize size_of_view(std::size_t view) const {
    const VideoReader& reader = readers_[split_ ? 0 : view];
    if (!split_) return {reader.width(), reader.height()};
    return view_size(layout_, reader.width(), reader.height(), files_[0].string());
  }

  /// Names the files, and how a file of both views holds them.
  void choose_files(const std::string& where) {
    const bool one = !params_.side_by_side.empty();
    if (one == !params_.left.empty() || (one && !params_.right.empty()))
      throw ConfigError(fmt::format("{}: expected either left (and right) or side_by_side", where));
    if (params_.layout && !params_.right.empty())
      throw ConfigError(fmt::format(
          "{}: layout is given together with right; expected one video of both views with it",
          where));
    split_ = one || params_.layout;
    layout_ = params_.layout.value_or(StereoLayout::side_by_side);
    files_ = {one ? params_.side_by_side : params_.left};
    if (!params_.right.empty()) files_.push_back(params_.right);
  }

  void open(const std::string& where) {
    choose_files(where);
    if (params_.offset != 0 && files_.size() != 2) {
      throw ConfigError(fmt::format("{}: offset is for two videos", where));
    }
    for (const std::filesystem::path& file : files_) readers_.emplace_back(file);
    if (files_.size() == 2 && !params_.frame_rate) check_rates();
  }

  void check_rates() const {
    const double left = readers_[0].frame_rate();
    const double right = readers_[1].frame_rate();
    if (left <= 0 || right <= 0 || std::abs(left - right) <= kSameRate * left) return;
    throw DataError(
        fmt::format("{} has {:.4g} frames per second, {} {:.4g}; expected equal ones, since the "
                    "videos are paired frame by frame. Convert one of them, or give `frame_rate` "
                    "if what the files say is wrong",
                    files_[0].string(), left, files_[1].string(), right));
  }

  void skip(std::size_t reader, int frames) {
    cv::Mat ignored;
    for (int i = 0; i < frames; ++i) {
      if (readers_[reader].next(ignored) == VideoReader::Result::end) return;
    }
  }

  void fill_views(Frame& frame, std::vector<cv::Mat>& images) const {
    if (split_) {
      const auto views = split_views(layout_, images[0]);
      images.assign(views.begin(), views.end());
    }
    for (std::size_t v = 0; v < images.size(); ++v) {
      const cv::Mat& image = images[v];
      if (image.cols != cameras_[v].width || image.rows != cameras_[v].height) {
        frame.problem = fmt::format("{}: the frame is {}x{} pixels; expected {}x{} as its camera",
                                    files_[split_ ? 0 : v].string(), image.cols, image.rows,
                                    cameras_[v].width, cameras_[v].height);
        frame.views.clear();
        return;
      }
      frame.views.push_back({image, {}});
    }
  }

  Params params_;
  bool split_ = false;  ///< one file holds both views
  StereoLayout layout_ = StereoLayout::side_by_side;
  std::vector<std::filesystem::path> files_;
  std::vector<VideoReader> readers_;
  std::vector<Camera> cameras_;
  std::vector<std::string> notes_;  ///< on the calibration
  TruthTables truth_;
  int first_ = 0;  ///< frame of the first video at which the source begins
  int index_ = 0;
};

}  // namespace hypotrack

HYPOTRACK_PLUGIN(
    hypotrack::Video,
    "One or two video files, or one with both views side by side or one above the other", "")
