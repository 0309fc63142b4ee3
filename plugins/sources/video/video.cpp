#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hypotrack/api/media.hpp"
#include "hypotrack/api/stereo_layout.hpp"
#include "hypotrack/api/timeline.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "params.hpp"

namespace hypotrack {

/// Reads two videos, whose frames pair by their times, or one with both views in it. Begins and
/// ends with a pair. Truth tables (`truth_states`, `truth_landmarks`) are CSV as described in
/// hypotrack/api/tables.hpp. Their frames are those of the first video, gaps counted, unless
/// `truth_offset` shifts them.
class Video : public Source {
 public:
  using Params = VideoParams;

  Video(const Params& params, PluginContext& context) : params_(params) {
    open(context.config().where());
    take_frames();
    const std::size_t views = split_ ? 2 : files_.size();
    const ImageSize first = size_of_view(0);
    std::vector<std::string> of_calibration;
    cameras_ = load_calibration(params.calibration, first, &of_calibration);
    notes_.insert(notes_.begin(), of_calibration.begin(), of_calibration.end());
    if (cameras_.size() != views) {
      throw DataError(
          fmt::format("{}: holds {} cameras, the source has {} views; expected one "
                      "camera per view, which `cameras` (calibration) chooses",
                      params.calibration.file.string(), cameras_.size(), views));
    }
    for (std::size_t v = 0; v < views; ++v) {
      const ImageSize size = size_of_view(v);
      fit_image_size(cameras_[v], size.width, size.height, infos_[split_ ? 0 : v].name);
    }
    if (!params.truth.states.empty() || !params.truth.landmarks.empty()) {
      truth_ = TruthTables(params.truth, context.scene());
      truth_.expect_some(*frames_.front().number, params.step, do_frame_count());
    }
  }

 private:
  const std::vector<Camera>& do_cameras() const override { return cameras_; }
  std::vector<std::string> do_notes() const override { return notes_; }
  double do_frame_rate() const override { return rate_ / params_.step; }
  std::optional<int> do_frame_count() const override { return static_cast<int>(frames_.size()); }

  std::vector<std::string> do_statistics() const override {
    std::vector<std::string> lines;
    if (!ended_) return lines;
    for (const VideoInfo& info : infos_)
      if (!info.problem_of_end.empty()) lines.push_back(info.problem_of_end);
    if (damaged_ > 0)
      lines.push_back(
          fmt::format("{} frames of the videos are damaged; pictures after them may be smeared "
                      "until the next key frame",
                      damaged_));
    return lines;
  }

  std::optional<Frame> do_next() override {
    ended_ = next_ == frames_.size();
    if (ended_) return std::nullopt;
    const TimelineFrame& moment = frames_[next_];
    Frame frame;
    frame.index = static_cast<int>(next_++);
    frame.time = moment.time - frames_.front().time;
    if (moment.number) frame.truth = truth_.at(*moment.number);
    frame.problem = missing_picture(infos_, moment);
    if (!frame.problem.empty()) return frame;
    std::vector<cv::Mat> images(files_.size());
    std::vector<std::string> problems(files_.size());
    tbb::parallel_for(std::size_t{0}, files_.size(), [&](std::size_t i) {
      problems[i] = files_[i]->read(*moment.pictures[i], images[i]);
    });
    for (std::string& problem : problems)
      if (frame.problem.empty()) frame.problem = std::move(problem);
    damaged_ += frame.problem.empty() ? 0 : 1;
    if (frame.problem.empty()) fill_views(frame, images);
    return frame;
  }

  /// Names the files, and how a file of both views holds them.
  std::vector<std::filesystem::path> choose_files(const std::string& where) {
    const bool one = !params_.side_by_side.empty();
    if (one == !params_.left.empty() || (one && !params_.right.empty()))
      throw ConfigError(fmt::format("{}: expected either left (and right) or side_by_side", where));
    if (params_.layout && !params_.right.empty())
      throw ConfigError(fmt::format(
          "{}: layout is given together with right; expected one video of both views with it",
          where));
    split_ = one || params_.layout;
    layout_ = params_.layout.value_or(StereoLayout::side_by_side);
    std::vector<std::filesystem::path> names{one ? params_.side_by_side : params_.left};
    if (!params_.right.empty()) names.push_back(params_.right);
    return names;
  }

  void open(const std::string& where) {
    const std::vector<std::filesystem::path> names = choose_files(where);
    const auto refuse = [&](bool given, const char* key) {
      if (given && names.size() != 2)
        throw ConfigError(fmt::format("{}: {} is for two videos", where, key));
    };
    refuse(params_.offset.value_or(0) != 0, "offset");
    refuse(params_.tolerance.has_value(), "tolerance_ms");
    for (const std::filesystem::path& name : names) {
      files_.push_back(open_video(name.string(), params_.colors));
      infos_.push_back(files_.back()->info());
      notes_.insert(notes_.end(), infos_.back().notes.begin(), infos_.back().notes.end());
    }
  }

  /// Throws DataError if a video ends before the frame that belongs to frame `start` of the first.
  void check_start(int start) const {
    const int offset = params_.offset.value_or(0);
    const int first = std::max(start, -offset);
    for (std::size_t i = 0; i < infos_.size(); ++i) {
      const int wanted = i == 0 ? first : first + offset;
      if (static_cast<std::size_t>(wanted) < infos_[i].times.size()) continue;
      throw DataError(fmt::format("{}: ends before frame {}, the first that start{} for",
                                  infos_[i].name, wanted,
                                  infos_.size() == 2 ? " and offset ask" : " asks"));
    }
  }

  /// Chooses the frames of the timeline that the source gives.
  void take_frames() {
    check_start(0);
    VideoTimeline line =
        make_timeline(infos_, {params_.offset, params_.frame_rate, params_.tolerance});
    notes_.insert(notes_.end(), line.notes.begin(), line.notes.end());
    rate_ = line.frame_rate;
    const auto begin = std::ranges::find_if(line.frames, [&](const TimelineFrame& frame) {
      return frame.number && *frame.number >= params_.start;
    });
    if (begin == line.frames.end()) {
      check_start(params_.start);
      throw DataError(
          fmt::format("{}: no pair is left from frame {} on, the first that start asks for",
                      infos_[0].name, params_.start));
    }
    const auto count = static_cast<std::size_t>(params_.count.value_or(1000000000));
    for (auto frame = begin; frames_.size() < count; frame += params_.step) {
      frames_.push_back(std::move(*frame));
      if (line.frames.end() - frame <= params_.step) break;
    }
  }

  /// Returns the size of a view's pictures.
  ImageSize size_of_view(std::size_t view) const {
    const VideoInfo& info = infos_[split_ ? 0 : view];
    if (!split_) return {info.width, info.height};
    return view_size(layout_, info.width, info.height, info.name);
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
                                    infos_[split_ ? 0 : v].name, image.cols, image.rows,
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
  std::vector<std::unique_ptr<VideoFile>> files_;
  std::vector<VideoInfo> infos_;
  std::vector<Camera> cameras_;
  std::vector<std::string> notes_;
  TruthTables truth_;
  double rate_ = 0;                    ///< frames per second of the first video
  std::vector<TimelineFrame> frames_;  ///< that the source gives
  std::size_t next_ = 0;
  int damaged_ = 0;  ///< frames so far
  bool ended_ = false;
};

}  // namespace hypotrack

HYPOTRACK_PLUGIN(hypotrack::Video, "One or two video files, or one with both views in it", "")
