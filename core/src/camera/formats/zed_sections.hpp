#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/config.hpp"

// Sections and keys of a ZED's factory calibration.

namespace hypotrack::calibration {
inline namespace HYPOTRACK_EXPORTED internal {

/// A resolution of a ZED's pictures.
struct Resolution {
  std::string_view name;
  int width, height;
};
inline constexpr std::array<Resolution, 8> kResolutions = {{{"2K", 2208, 1242},
                                                            {"FHD", 1920, 1080},
                                                            {"FHD1200", 1920, 1200},
                                                            {"HD", 1280, 720},
                                                            {"SVGA", 960, 600},
                                                            {"VGA", 672, 376},
                                                            {"4k", 3840, 2160},
                                                            {"QHDPLUS", 3200, 1800}}};

using Keys = std::span<const std::string_view>;
inline constexpr std::array<std::string_view, 4> kPinhole = {"fx", "fy", "cx", "cy"};
/// In OpenCV's order. The last three are those of the rational model.
inline constexpr std::array<std::string_view, 8> kCoefficients = {"k1", "k2", "p1", "p2",
                                                                  "k3", "k4", "k5", "k6"};
inline constexpr std::array<std::string_view, 4> kThinPrism = {"s1", "s2", "s3", "s4"};

inline constexpr std::array<std::string_view, 11> kOtherNames = {
    "STEREO", "MISC", "LEFT_DISTO", "RIGHT_DISTO", "Baseline", "TY",
    "TZ",     "CV",   "RX",         "RZ",          "Sensor_ID"};

/// Returns whether a text is a factory calibration: an INI file with a section [LEFT_CAM_...], in
/// letters of any case.
bool is_zed_text(std::string_view text);

/// Returns such a text as TOML, line by line: without comments that begin with `;` or `#`, with
/// known names in their usual case and texts in quotes.
std::string zed_as_toml(std::string_view text);

/// Returns those of some keys that a section has.
std::vector<std::string_view> found_in(const ConfigNode& section, Keys keys);

/// Adds one note on everything in a file that is not used for pictures of a size.
void note_unused_sections(const ConfigNode& file, const Resolution& size,
                          const std::string& file_name, std::vector<std::string>& notes);

}  // namespace internal
}  // namespace hypotrack::calibration
