#include "capture.hpp"

#include <fmt/format.h>

#include <exception>
#include <string>

namespace hypotrack::live {
namespace {

constexpr double kUsualRate = 30;

/// Reads pictures until the device gives no more. The first ones waited in buffers for an unknown
/// time, which is seen by how fast they come; they are left out. A stream's are many: FFmpeg looks
/// at seconds of it before the first picture.
void read_device(Device& device, const DeviceSettings& settings, PictureQueues& pictures,
                 std::size_t index) {
  const double usual_wait = 0.5e9 / settings.params.fps.value_or(kUsualRate);
  int may_be_old = settings.is_stream() ? 100 : 8;
  std::size_t told = device.refused().size();
  while (!pictures.stopped()) {
    const std::int64_t begin = now();
    Picture picture;
    const Device::Result result = device.read(picture);
    for (; told < device.refused().size(); ++told) pictures.tell(index, device.refused()[told]);
    if (result == Device::Result::end) return;
    if (result == Device::Result::damaged) {
      pictures.add_damaged(index);
      continue;
    }
    if (may_be_old > 0 && static_cast<double>(picture.arrival - begin) < usual_wait) {
      --may_be_old;
      continue;
    }
    may_be_old = 0;
    pictures.add(index, std::move(picture));
  }
}

/// Opens and reads a device until the capture ends.
void capture_device(const DeviceSettings& settings, PictureQueues& pictures, std::size_t index) {
  constexpr double kPause = 0.2;  // seconds before a device is opened again
  do {
    try {
      Device device(settings);
      std::string problem = device.open();
      if (problem.empty()) {
        pictures.opened(index, device.stated_rate(), device.refused());
        read_device(device, settings, pictures, index);
        problem = fmt::format("{}: the pictures stopped", settings.label());
      }
      pictures.lost(index, std::move(problem));
    } catch (const std::exception& e) {
      pictures.lost(index, fmt::format("{}: {}", settings.label(), e.what()));
    }
  } while (pictures.sleep(kPause));
  pictures.ended(index);
}

}  // namespace

Capture::Capture(const std::vector<DeviceSettings>& devices) {
  std::vector<std::string> names;
  for (const DeviceSettings& device : devices) names.push_back(device.label());
  pictures_ = std::make_shared<PictureQueues>(names);
  for (std::size_t i = 0; i < devices.size(); ++i) {
    threads_.emplace_back([pictures = pictures_, settings = devices[i], i] {
      capture_device(settings, *pictures, i);
    });
  }
}

Capture::~Capture() {
  constexpr std::int64_t kPatience = 1'000'000'000;
  const std::vector<bool> ended = pictures_->stop(now() + kPatience);
  for (std::size_t i = 0; i < threads_.size(); ++i) {
    if (ended[i])
      threads_[i].join();
    else
      threads_[i].detach();
  }
}

}  // namespace hypotrack::live
