#pragma once

#include <memory>
#include <thread>
#include <vector>

#include "device.hpp"
#include "picture_queues.hpp"

namespace hypotrack::live {

/// Reads each device in a thread of its own and opens those again that stop.
class Capture {
 public:
  explicit Capture(const std::vector<DeviceSettings>& devices);
  /// Ends the threads. One that hangs in a driver or a network is left behind.
  ~Capture();
  Capture(const Capture&) = delete;
  Capture& operator=(const Capture&) = delete;

  PictureQueues& pictures() const { return *pictures_; }

 private:
  std::shared_ptr<PictureQueues> pictures_;  ///< shared with the threads
  std::vector<std::thread> threads_;
};

}  // namespace hypotrack::live
