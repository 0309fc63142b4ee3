#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "expect_error.hpp"
#include "hypotrack/api/config.hpp"
#include "hypotrack/api/error.hpp"
#include "test_paths.hpp"

namespace hypotrack::test {

/// A folder with a scene, scene.yaml, and files that it refers to.
class SceneFolder : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories(file(name).parent_path());
    std::ofstream(file(name)) << text;
  }
  std::filesystem::path file(const std::string& name) const { return folder_.path() / name; }

  ConfigNode load(const std::string& text, const std::vector<std::string>& overrides = {}) const {
    write("scene.yaml", text);
    return ConfigNode::load_scene(file("scene.yaml"), overrides);
  }
  std::string error(const std::string& text, const std::vector<std::string>& overrides = {}) const {
    return message_of<ConfigError>([&] { load(text, overrides); });
  }

 private:
  TemporaryDirectory folder_;
};

}  // namespace hypotrack::test
