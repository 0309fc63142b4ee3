#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/subprocess.hpp"
#include "test_paths.hpp"

namespace hypotrack::test {

/// A network camera on this machine: mjpeg_server.py in a process of its own.
class MjpegServer {
 public:
  /// Plays the JPEG files that a pattern names; `options` are those of mjpeg_server.py.
  explicit MjpegServer(const std::filesystem::path& pictures,
                       std::vector<std::string> options = {}) {
    const std::filesystem::path port_file = folder_.path() / "port";
    std::vector<std::string> arguments{(source_dir() / "tests/support/mjpeg_server.py").string(),
                                       pictures.string(), "--port-file", port_file.string()};
    arguments.insert(arguments.end(), options.begin(), options.end());
    process_.emplace(Subprocess::Command{.program = "/usr/bin/python3", .arguments = arguments});
    while (process_->running() && !std::filesystem::exists(port_file))
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    std::ifstream(port_file) >> port_;
    EXPECT_GT(port_, 0) << "the server did not start";
  }

  std::string url() const { return "http://127.0.0.1:" + std::to_string(port_) + "/stream"; }

 private:
  TemporaryDirectory folder_;
  std::optional<Subprocess> process_;
  int port_ = 0;
};

}  // namespace hypotrack::test
