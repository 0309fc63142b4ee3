#include "device.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

namespace hypotrack::live {
namespace {

/// Returns the device file that a number or path names.
std::filesystem::path device_file(const std::string& name) {
  const bool number = std::ranges::all_of(name, [](char c) { return c >= '0' && c <= '9'; });
  return number ? "/dev/video" + name : name;
}

/// Lists the V4L2 devices of this machine for a message.
std::string found_devices() {
  std::vector<std::string> found;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/dev", error)) {
    const std::string name = entry.path().string();
    if (name.starts_with("/dev/video")) found.push_back(name);
  }
  std::ranges::sort(found);
  if (found.empty()) return "this machine has no /dev/video*: is the camera connected?";
  return fmt::format("expected one of {}", fmt::join(found, ", "));
}

/// Returns why a device file cannot be opened, or nothing.
std::string problem_of_file(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) {
    return fmt::format("{}: there is no such device; {}", file.string(), found_devices());
  }
  if (!std::filesystem::is_character_file(file, error)) {
    return fmt::format(
        "{}: is no device; {}, or a URL such as http://HOST/stream. The source `video` reads files",
        file.string(), found_devices());
  }
  if (access(file.c_str(), R_OK | W_OK) != 0) {
    return fmt::format(
        "{}: you may not open this device; add yourself to its group (usermod -aG video USER) and "
        "log in again",
        file.string());
  }
  return {};
}

/// Returns true if a JPEG file ends with its end marker. A file that was cut off decodes to a
/// picture all the same.
bool ends_whole(const cv::Mat& file) {
  const std::size_t size = file.total();
  if (!file.isContinuous() || file.elemSize() != 1) return false;
  std::size_t end = size;
  while (end > 0 && file.data[end - 1] == 0) --end;  // padding
  return end > 3 && file.data[end - 2] == 0xFF && file.data[end - 1] == 0xD9;
}

}  // namespace

std::int64_t now() {
  return std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}

bool DeviceSettings::is_stream() const { return name.find("://") != std::string::npos; }

bool DeviceSettings::is_pipeline() const {
  return !is_stream() && name.find('!') != std::string::npos;
}

std::string DeviceSettings::label() const {
  constexpr std::size_t kLongest = 60;
  std::string shown = name;
  const std::size_t host = name.find("://") + 3;
  const std::size_t at = name.find('@');
  if (is_stream() && at < name.find('/', host)) shown.replace(host, at - host, "...");
  if (shown.size() > kLongest) shown.replace(kLongest, std::string::npos, "...");
  return fmt::format("{} ({})", role, shown);
}

std::string Device::open() {
  try {
    if (settings_.is_stream()) return open_stream();
    if (settings_.is_pipeline()) return open_pipeline();
    return open_v4l2();
  } catch (const cv::Exception& e) {
    return fmt::format("{}: OpenCV cannot open it: {}", settings_.label(), e.what());
  }
}

std::string Device::open_v4l2() {
  const std::filesystem::path file = device_file(settings_.name);
  if (std::string problem = problem_of_file(file); !problem.empty()) {
    return fmt::format("{}: {}", settings_.role, problem);
  }
  if (!capture_.open(file.string(), cv::CAP_V4L2)) {
    return fmt::format(
        "{}: {}: cannot be opened as a camera; does another program use it, or does it deliver no "
        "pictures (v4l2-ctl --list-devices)?",
        settings_.role, file.string());
  }
  apply_settings();
  return {};
}

std::string Device::open_stream() {
  constexpr int kOpenMs = 10000;
  const std::vector<int> limits{cv::CAP_PROP_OPEN_TIMEOUT_MSEC, kOpenMs,
                                cv::CAP_PROP_READ_TIMEOUT_MSEC, cvRound(settings_.timeout * 1e3)};
  if (!capture_.open(settings_.name, cv::CAP_FFMPEG, limits)) {
    return fmt::format(
        "{}: the stream cannot be opened; is the address right, does the camera answer there, and "
        "is it MJPEG or RTSP?",
        settings_.label());
  }
  // Motion JPEG arrives as files, so that one that was cut off on its way can be told.
  const int codec = static_cast<int>(capture_.get(cv::CAP_PROP_FOURCC));
  jpeg_ = codec == cv::VideoWriter::fourcc('m', 'j', 'p', 'e') ||
          codec == cv::VideoWriter::fourcc('M', 'J', 'P', 'G');
  jpeg_ = jpeg_ && capture_.set(cv::CAP_PROP_FORMAT, -1);
  return {};
}

std::string Device::open_pipeline() {
  if (capture_.open(settings_.name, cv::CAP_GSTREAMER)) return {};
  return fmt::format(
      "{}: GStreamer cannot open the pipeline; expected one that ends in `videoconvert ! "
      "video/x-raw,format=BGR ! appsink max-buffers=1 drop=true`. Try it with gst-launch-1.0 and "
      "autovideosink",
      settings_.label());
}

/// Notes that the device refused a setting if it does not have the value.
void Device::expect(int property, double value, double tolerance, const std::string& what) {
  const double found = capture_.get(property);
  if (std::abs(found - value) <= tolerance * value) return;
  refused_.push_back(fmt::format("{}: the device does not take {} {:g}; it says {:g}",
                                 settings_.label(), what, value, found));
}

void Device::set(int property, double value, double tolerance, const std::string& what) {
  capture_.set(property, value);
  expect(property, value, tolerance, what);
}

void Device::set_pixel_format(const std::string& letters) {
  const int code = cv::VideoWriter::fourcc(letters[0], letters[1], letters[2], letters[3]);
  if (capture_.set(cv::CAP_PROP_FOURCC, code) &&
      static_cast<int>(capture_.get(cv::CAP_PROP_FOURCC)) == code)
    return;
  refused_.push_back(
      fmt::format("{}: the device does not take pixel_format {}", settings_.label(), letters));
}

void Device::set_size() {
  const DeviceParams& p = settings_.params;
  if (!p.width && !p.height) return;
  const double width = p.width ? *p.width : capture_.get(cv::CAP_PROP_FRAME_WIDTH);
  const double height = p.height ? *p.height : capture_.get(cv::CAP_PROP_FRAME_HEIGHT);
  capture_.set(cv::CAP_PROP_FRAME_WIDTH, width);  // waits for the height
  capture_.set(cv::CAP_PROP_FRAME_HEIGHT, height);
  expect(cv::CAP_PROP_FRAME_WIDTH, width, 0, "width");
  expect(cv::CAP_PROP_FRAME_HEIGHT, height, 0, "height");
}

void Device::apply_settings() {
  constexpr double kRounded = 0.02;
  const DeviceParams& p = settings_.params;
  if (!p.pixel_format.empty()) set_pixel_format(p.pixel_format);
  set_size();
  if (p.fps) set(cv::CAP_PROP_FPS, *p.fps, kRounded, "fps");
  if (p.exposure) {
    constexpr double kManual = 1;   // V4L2_EXPOSURE_MANUAL
    constexpr double kUnit = 1e-4;  // seconds, of V4L2_CID_EXPOSURE_ABSOLUTE
    constexpr double kStep = 0.1;
    capture_.set(cv::CAP_PROP_AUTO_EXPOSURE, kManual);
    set(cv::CAP_PROP_EXPOSURE, std::round(*p.exposure / kUnit), kStep, "exposure (of 0.1 ms)");
  }
  if (p.white_balance) {
    capture_.set(cv::CAP_PROP_AUTO_WB, 0);
    set(cv::CAP_PROP_WB_TEMPERATURE, *p.white_balance, kRounded, "white_balance");
  }
}

double Device::stated_rate() const {
  if (jpeg_) return 0;  // HTTP does not say, and FFmpeg then says 25
  const double rate = capture_.get(cv::CAP_PROP_FPS);
  return rate >= 0.1 && rate <= 2000 ? rate : 0;
}

/// Returns the time at which the V4L2 driver says that the picture began. Other devices say none,
/// and some drivers use another clock: their pictures have the time of their arrival.
std::int64_t Device::stamp_of(std::int64_t arrival) const {
  constexpr std::int64_t kOldest = 1'000'000'000;
  if (!settings_.is_v4l2()) return arrival;
  const auto driver = static_cast<std::int64_t>(capture_.get(cv::CAP_PROP_POS_MSEC) * 1e6);
  return driver > arrival - kOldest && driver <= arrival ? driver : arrival;
}

/// Notes that the Exif data of a JPEG file turned its picture.
void Device::note_turn(const cv::Mat& file, const cv::Mat& upright) {
  const cv::Mat stored = cv::imdecode(file, cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION);
  if (stored.size() == upright.size() && cv::norm(stored, upright, cv::NORM_INF) == 0) return;
  refused_.push_back(
      fmt::format("{}: its pictures are turned as their Exif data say and viewers do; the "
                  "calibration must be of turned pictures",
                  settings_.label()));
}

cv::Mat Device::decoded() {
  cv::Mat image;
  if (!capture_.retrieve(image) || image.empty()) return {};
  if (jpeg_) {
    if (!ends_whole(image)) return {};
    const cv::Mat upright = cv::imdecode(image, cv::IMREAD_COLOR);
    if (!std::exchange(decoded_any_, true)) note_turn(image, upright);
    return upright;
  }
  if (image.channels() == 1) cv::cvtColor(image, image, cv::COLOR_GRAY2BGR);
  if (image.type() != CV_8UC3) return {};
  return image.clone();  // the decoder reuses its memory for the next picture
}

Device::Result Device::read(Picture& picture) {
  try {
    if (!capture_.grab()) return Result::end;
  } catch (const cv::Exception&) {
    return Result::end;
  }
  picture.arrival = now();
  picture.stamp = stamp_of(picture.arrival);
  try {
    picture.image = decoded();
  } catch (const cv::Exception&) {
    picture.image.release();
  }
  return picture.image.empty() ? Result::damaged : Result::picture;
}

}  // namespace hypotrack::live
