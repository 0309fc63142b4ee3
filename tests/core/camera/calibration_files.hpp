#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "hypotrack/api/calibration.hpp"
#include "test_paths.hpp"

namespace hypotrack::test {

/// Writes calibration files and reads them.
class CalibrationFiles : public testing::Test {
 protected:
  /// Returns a text with its first `what` replaced.
  static std::string with(std::string text, const std::string& what, const std::string& by) {
    const std::size_t at = text.find(what);
    if (at == std::string::npos) throw std::logic_error("the text does not hold " + what);
    return text.replace(at, what.size(), by);
  }
  CalibrationSettings file(const std::string& name, const std::string& text) {
    CalibrationSettings settings;
    settings.file = write(name, text);
    return settings;
  }
  std::filesystem::path write(const std::string& name, const std::string& text) {
    const std::filesystem::path path = folder_.path() / name;
    std::ofstream(path, std::ios::binary) << text;
    return path;
  }
  auto loading(const CalibrationSettings& settings, ImageSize pictures = {}) {
    return [=] { load_calibration(settings, pictures); };
  }
  TemporaryDirectory folder_;
};

}  // namespace hypotrack::test
