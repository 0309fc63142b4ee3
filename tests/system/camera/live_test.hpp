#pragma once

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "app_test.hpp"
#include "mjpeg_server.hpp"

namespace hypotrack::test {

/// A rendered box, played by cameras of this machine.
class LiveTest : public AppTest {
 protected:
  /// Renders the box and writes its pictures as JPEG: left, right and both side by side.
  void SetUp() override {
    const Outcome outcome = run_program(
        {"synth", scene(box_scene(), "synthetic.yaml"), "--out", path("rendered").string()});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    for (int i = 0; i < 5; ++i) {
      const auto read = [&](const char* side) {
        return cv::imread(cv::format("%s/%s_%06d.png", path("rendered").c_str(), side, i));
      };
      const cv::Mat left = read("left"), right = read("right");
      cv::Mat both;
      cv::hconcat(left, right, both);
      for (const auto& [name, image] : {std::pair("left", left), {"right", right}, {"both", both}})
        cv::imwrite(cv::format("%s/%s_%d.jpg", path("rendered").c_str(), name, i), image);
    }
  }

  std::filesystem::path pictures(const std::string& name) const {
    return path("rendered") / (name + "_?.jpg");
  }

  /// A scene of the box before live cameras; `devices` are parameters of the source.
  static std::string live_scene(const std::string& devices) {
    return "models: [{name: box, type: rigid_box, size_mm: [90, 60, 40]}]\n"
           "source:\n  type: camera\n  calibration: {file: rendered/calibration.yaml}\n" +
           devices +
           "objective: {type: stereo_color}\n"
           "optimizer: {type: pso, particles: 8, generations: 4}\n"
           "tile: {size: 32}\n"
           "init: {from: rest, pose: {box: {position_mm: [10, 5, 410], rotation_deg: [20, 35, "
           "5]}}}\n"
           "output: {overlay: false}\n";
  }
  static std::string two_devices(const MjpegServer& left, const MjpegServer& right) {
    return "  left: \"" + left.url() + "\"\n  right: \"" + right.url() + "\"\n";
  }
  static std::string one_device(const MjpegServer& both) {
    return "  device: \"" + both.url() + "\"\n";
  }

  static cv::Mat read_picture(const std::filesystem::path& file) {
    return cv::imread(file.string());
  }
};

}  // namespace hypotrack::test
