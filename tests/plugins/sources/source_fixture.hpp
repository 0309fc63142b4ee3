#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "test_models.hpp"
#include "test_paths.hpp"

namespace hypotrack::test {

/// A folder for a recording, and sources made from YAML as a scene makes them.
class SourceFixture : public testing::Test {
 protected:
  SourceFixture() { calibrate(64, 48, 2); }

  std::filesystem::path file(const std::string& name) const { return folder_.path() / name; }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(file(name), std::ios::binary) << text;
  }

  /// Writes rig.yml: pinhole cameras 0.1 m apart.
  void calibrate(int width, int height, int cameras) const {
    std::string text = "%YAML:1.0\n---\ncameras:\n";
    for (int i = 0; i < cameras; ++i) {
      text += "  - image_width: " + std::to_string(width) +
              "\n    image_height: " + std::to_string(height) +
              "\n    K: [60, 0, 32, 0, 60, 24, 0, 0, 1]\n    R: [1, 0, 0, 0, 1, 0, 0, 0, 1]\n"
              "    T: [-" +
              std::to_string(0.1 * i) + ", 0, 0]\n";
    }
    write("rig.yml", text);
  }

  /// A picture that tells its number and view by its colours.
  static cv::Mat picture(int number, int view, cv::Size size = {64, 48}) {
    cv::Mat image(size, CV_8UC3, cv::Scalar(10 * number, 100 * view, 50));
    cv::rectangle(image, cv::Rect(5, 5, 20, 10), cv::Scalar(255, 255, 255), cv::FILLED);
    return image;
  }

  /// A source from YAML lines; relative paths refer to the folder.
  std::unique_ptr<Source> make(const std::string& yaml, const Scene* scene = nullptr) {
    return plugins_.make<Source>(ConfigNode::parse(yaml, "scene.yaml", folder_.path()), scene);
  }

  TemporaryDirectory folder_;
  PluginLoader plugins_;
  Scene scene_{{{"box", std::make_shared<Model>(make_test_box())}}};
};

}  // namespace hypotrack::test
