#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "capture.hpp"
#include "hypotrack/api/calibration.hpp"
#include "hypotrack/plugin/numbers.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "params.hpp"

namespace hypotrack::live {
namespace {

std::int64_t nanoseconds(double seconds) { return std::llround(1e9 * seconds); }

/// Returns what to add to now() for Unix time.
std::int64_t unix_from_now() {
  const auto wall = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::nanoseconds(wall).count() - now();
}

/// Returns the devices that the parameters name. Throws ConfigError.
std::vector<DeviceSettings> devices_of(const Params& params, const ConfigNode& config) {
  const bool both = !params.left.empty() && !params.right.empty();
  const bool any = !params.left.empty() || !params.right.empty();
  if (params.device.empty() ? !both : any) {
    throw ConfigError(
        fmt::format("{}: expected either device (one picture of both views) or left and right",
                    config.where()));
  }
  std::vector<DeviceSettings> devices;
  if (!any) devices.push_back({"device", params.device, params.settings, params.timeout});
  if (any) devices.push_back({"left", params.left, params.settings, params.timeout});
  if (any) devices.push_back({"right", params.right, params.settings, params.timeout});
  if (any && config.get("layout").defined())
    throw ConfigError(
        fmt::format("{}: layout is given, but left and right are two devices; "
                    "expected it with `device`",
                    config.where_key("layout")));
  if (any && params.left == params.right) {
    throw ConfigError(
        fmt::format("{}: left and right are the same device; expected two, or "
                    "`device` for one that delivers both views",
                    config.where_key("right")));
  }
  const std::string& format = params.settings.pixel_format;
  if (!format.empty() && format.size() != 4) {
    throw ConfigError(fmt::format("{}: pixel_format is '{}'; expected four letters, such as MJPG",
                                  config.where_key("pixel_format"), format));
  }
  const auto is_v4l2 = [](const DeviceSettings& d) { return d.is_v4l2(); };
  if (std::ranges::all_of(devices, is_v4l2)) return devices;
  for (const char* key : {"width", "height", "pixel_format", "exposure_ms", "white_balance"}) {
    if (!config.get(key).defined()) continue;
    throw ConfigError(fmt::format(
        "{}: {} is given, but only V4L2 devices can be set; set it where the stream or pipeline "
        "comes from",
        config.where_key(key), key));
  }
  return devices;
}

/// Delivers the newest pair of a live camera or of two.
class LiveCamera final : public Source {
 public:
  using Params = live::Params;

  LiveCamera(const Params& params, PluginContext& context)
      : params_(params),
        devices_(devices_of(params, context.config())),
        cameras_(params.uncalibrated
                     ? std::vector<Camera>(2)
                     : load_calibration(params.calibration, wanted_size(), &notes_)) {
    if (cameras_.size() != 2) {
      throw DataError(
          fmt::format("{}: holds {} cameras; expected two, one for each view, which `cameras` "
                      "(calibration) chooses",
                      params.calibration.file.string(), cameras_.size()));
    }
    capture_.emplace(devices_);
    wait_for_pictures();
    check_pictures();
    tolerance_ = nanoseconds(params.tolerance.value_or(0.6 / rate_));
    last_pair_ = now();
  }

 private:
  const std::vector<Camera>& do_cameras() const override { return cameras_; }
  double do_frame_rate() const override { return rate_; }
  bool do_live() const override { return true; }

  std::optional<Frame> do_next() override {
    const std::int64_t give_up = last_pair_ + nanoseconds(params_.give_up);
    const std::int64_t deadline = std::min(now() + nanoseconds(params_.timeout), give_up);
    const std::vector<Picture> pair = pictures().take(last_stamp_, tolerance_, deadline);
    const std::int64_t time = pair.empty() ? now() : pair[0].stamp;
    if (pair.empty() && time >= give_up) {
      throw DataError(
          fmt::format("source camera: no pair of pictures for {:g} s, which ends the run: {}. "
                      "give_up_s is how long a run waits",
                      params_.give_up, pictures().problem(tolerance_)));
    }
    Frame frame;
    frame.index = index_++;
    if (!start_) start_ = time;
    last_stamp_ = time;
    frame.time = static_cast<double>(1e-9L * static_cast<long double>(time - *start_));
    frame.stamp = time + unix_from_now_;
    if (pair.empty()) {
      frame.problem = pictures().problem(tolerance_);
    } else {
      frame.taken = std::chrono::steady_clock::time_point(std::chrono::nanoseconds(time));
      add_views(frame, pair);
    }
    return frame;
  }

  std::vector<std::string> do_notes() const override {
    std::vector<std::string> notes = notes_;
    for (std::string& setting : refused()) notes.push_back(std::move(setting));
    return notes;
  }

  std::vector<std::string> do_statistics() const override {
    std::string text = fmt::format("camera: {} pairs", pairs_);
    if (pairs_ > 1) text += fmt::format(" at {:.1f} per second", pair_rate());
    if (!offsets_.empty()) {
      text += fmt::format("; offset of their pictures: median {:.1f} ms, largest {:.1f} ms{}",
                          1e-6 * static_cast<double>(upper_median(offsets_)),
                          1e-6 * static_cast<double>(std::ranges::max(offsets_)),
                          by_arrival_ ? ", by their arrival: a stream does not say when it took "
                                        "them, so that they may be farther apart"
                                      : "");
    }
    std::vector<std::string> lines{std::move(text)};
    for (std::size_t i = 0; i < devices_.size(); ++i) {
      const DeviceCounts counts = pictures().counts(i);
      lines.push_back(fmt::format("camera: {}: {} pictures, {} dropped, {} damaged, {} reconnects",
                                  devices_[i].label(), counts.pictures, counts.dropped,
                                  counts.damaged, counts.reconnects));
    }
    return lines;
  }

  PictureQueues& pictures() const { return capture_->pictures(); }

  /// Returns the size of a view's pictures that the scene asks for; zeros if it does not.
  ImageSize wanted_size() const {
    const live::DeviceParams& wanted = params_.settings;
    if (!wanted.width || !wanted.height) return {};
    if (devices_.size() == 2) return {*wanted.width, *wanted.height};
    return view_size(params_.layout, *wanted.width, *wanted.height,
                     "the size that the scene asks for");
  }

  /// Waits for the first pictures, to know their rate.
  void wait_for_pictures() {
    constexpr int kMeasured = 10;
    constexpr double kPatience = 15;  // seconds; opening takes 10 at most
    const std::string problem =
        pictures().wait_for_first(kMeasured, now() + nanoseconds(kPatience));
    if (!problem.empty()) throw DataError(problem);
    const double measured = std::round(100 * pictures().rate(0)) / 100;
    rate_ = params_.settings.fps.value_or(measured > 0 ? measured : 30);
  }

  /// Takes the sizes of the pictures. An error also says what the devices refused.
  void check_pictures() {
    try {
      take_image_sizes();
    } catch (const DataError& e) {
      std::string text = e.what();
      for (const std::string& setting : refused()) text += "; " + setting;
      throw DataError(text);
    }
  }

  /// Returns the settings that the devices refused.
  std::vector<std::string> refused() const {
    std::vector<std::string> out;
    for (std::size_t i = 0; i < devices_.size(); ++i) {
      for (std::string& setting : pictures().refused(i)) out.push_back(std::move(setting));
    }
    return out;
  }

  void take_image_sizes() {
    const cv::Size first = pictures().size(0);
    if (devices_.size() == 1) {
      const ImageSize view =
          view_size(params_.layout, first.width, first.height, devices_[0].label());
      for (Camera& camera : cameras_)
        fit_image_size(camera, view.width, view.height, devices_[0].label());
      return;
    }
    const cv::Size second = pictures().size(1);
    if (first != second && (cameras_[0].width == 0 || cameras_[1].width == 0)) {
      throw DataError(fmt::format(
          "{} delivers {}x{} pixels, {} {}x{}; expected equal sizes, or a calibration that gives "
          "the size of each camera",
          devices_[0].label(), first.width, first.height, devices_[1].label(), second.width,
          second.height));
    }
    fit_image_size(cameras_[0], first.width, first.height, devices_[0].label());
    fit_image_size(cameras_[1], second.width, second.height, devices_[1].label());
  }

  void add_views(Frame& frame, const std::vector<Picture>& pair) {
    ++pairs_;
    last_pair_ = now();
    if (!first_pair_) first_pair_ = pair[0].stamp;
    newest_pair_ = pair[0].stamp;
    std::vector<cv::Mat> images;
    if (pair.size() == 2) {
      offsets_.push_back(std::abs(pair[1].stamp - pair[0].stamp));
      for (const Picture& picture : pair) by_arrival_ |= picture.stamp == picture.arrival;
      images = {pair[0].image, pair[1].image};
    } else {
      const auto views = split_views(params_.layout, pair[0].image);
      images.assign(views.begin(), views.end());
    }
    for (std::size_t v = 0; v < images.size(); ++v) {
      const Camera& camera = cameras_[v];
      if (images[v].size() != cv::Size(camera.width, camera.height)) {
        frame.problem = fmt::format("view {}: the picture is {}x{} pixels; expected {}x{}", v,
                                    images[v].cols, images[v].rows, camera.width, camera.height);
        frame.views.clear();
        return;
      }
      frame.views.push_back({images[v], {}});
    }
  }

  /// Returns pairs per second, of at least two.
  double pair_rate() const {
    return 1e9 * (pairs_ - 1) / static_cast<double>(newest_pair_ - *first_pair_);
  }

  Params params_;
  std::vector<DeviceSettings> devices_;
  std::vector<std::string> notes_;  ///< on the calibration
  std::vector<Camera> cameras_;
  std::optional<Capture> capture_;
  double rate_ = 30;
  std::int64_t tolerance_ = 0;
  int index_ = 0;
  /// Stays the same when the wall clock is set, so that stamps grow.
  std::int64_t unix_from_now_ = unix_from_now();
  std::optional<std::int64_t> start_;  ///< of frame 0; this and all below: of now()
  std::int64_t last_stamp_ = 0;        ///< of the last frame, missing ones included
  std::int64_t last_pair_ = 0;         ///< when the last pair was taken
  std::optional<std::int64_t> first_pair_;
  std::int64_t newest_pair_ = 0;
  int pairs_ = 0;
  std::vector<std::int64_t> offsets_;  ///< of all pairs, nanoseconds
  bool by_arrival_ = false;            ///< a device does not say when it takes pictures
};

}  // namespace
}  // namespace hypotrack::live

HYPOTRACK_PLUGIN(
    hypotrack::live::LiveCamera,
    "a live stereo camera, or two cameras: V4L2 devices, streams or GStreamer pipelines", "")
