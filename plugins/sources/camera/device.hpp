#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <opencv2/videoio.hpp>
#include <string>
#include <vector>

#include "params.hpp"

namespace hypotrack::live {

/// Returns the time of the system's monotonic clock in nanoseconds.
std::int64_t now();

/// A device and how to open it.
struct DeviceSettings {
  std::string role;  ///< device, left or right
  std::string name;  ///< as the scene gives it
  DeviceParams params;
  double timeout = 2;  ///< seconds without a picture that end a stream

  bool is_stream() const;    ///< URL
  bool is_pipeline() const;  ///< of GStreamer
  bool is_v4l2() const { return !is_stream() && !is_pipeline(); }
  /// Returns role and name for messages, without the password of a URL. A long name is cut.
  std::string label() const;
};

/// A picture and its times, in nanoseconds of now().
struct Picture {
  cv::Mat image;             ///< 8-bit BGR
  std::int64_t stamp = 0;    ///< when it was taken; when it arrived if the device does not say
  std::int64_t arrival = 0;  ///< when it arrived, before it was decoded
};

/// An open camera or stream.
class Device {
 public:
  explicit Device(DeviceSettings settings) : settings_(std::move(settings)) {}

  /// Opens the device and applies the settings. Returns why that failed, or nothing.
  std::string open();
  /// Returns what the device refused of its settings, and after the first picture how it is turned.
  const std::vector<std::string>& refused() const { return refused_; }

  /// Returns the pictures per second that the device states; 0 if it does not.
  double stated_rate() const;

  enum class Result { picture, damaged, end };
  /// Waits for the next picture. `end`: there is none within the time-out, or the stream ended.
  Result read(Picture& picture);

 private:
  std::string open_v4l2();
  std::string open_stream();
  std::string open_pipeline();
  void expect(int property, double value, double tolerance, const std::string& what);
  void set(int property, double value, double tolerance, const std::string& what);
  void set_pixel_format(const std::string& letters);
  void set_size();
  void apply_settings();
  std::int64_t stamp_of(std::int64_t arrival) const;
  cv::Mat decoded();
  void note_turn(const cv::Mat& file, const cv::Mat& upright);

  DeviceSettings settings_;
  cv::VideoCapture capture_;
  std::vector<std::string> refused_;
  bool jpeg_ = false;         ///< pictures come as JPEG files
  bool decoded_any_ = false;  ///< of them
};

}  // namespace hypotrack::live
