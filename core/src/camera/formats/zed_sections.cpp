#include "camera/formats/zed_sections.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>

#include "camera/formats/unused_keys.hpp"

namespace hypotrack::calibration::internal {
namespace {

bool is_one_of(std::string_view key, Keys keys) {
  return std::ranges::find(keys, key) != keys.end();
}

/// Unused parts of a file: names of sections, and of keys as `[SECTION] key`.
struct Unused {
  std::vector<std::string> other_sizes, older_lenses, unknown;
};

bool is_resolution(std::string_view name) {
  return std::ranges::any_of(kResolutions, [&](const auto& size) { return size.name == name; });
}

/// Returns whether a key is of the pose, for all resolutions or for one: RX, RX_HD.
bool is_of_the_pose(std::string_view key) {
  constexpr std::array<std::string_view, 5> kPose = {"TY", "TZ", "CV", "RX", "RZ"};
  const std::size_t mark = key.find('_');
  return key == "Baseline" ||
         (is_one_of(key.substr(0, mark), kPose) &&
          (mark == std::string_view::npos || is_resolution(key.substr(mark + 1))));
}

/// Returns the resolution of LEFT_CAM_HD; empty for other names.
std::string_view resolution_in(std::string_view name) {
  for (const std::string_view before : {"LEFT_CAM_", "RIGHT_CAM_"})
    if (name.starts_with(before) && is_resolution(name.substr(before.size())))
      return name.substr(before.size());
  return {};
}

void look_for_unused(const ConfigNode& file, const std::string& name, const Resolution& size,
                     Unused& unused) {
  const ConfigNode section = file.get(name);
  const std::string_view resolution = resolution_in(name);
  const bool of_all_sizes = name == "LEFT_DISTO" || name == "RIGHT_DISTO";
  if (name == "units") return;
  if (!section.is_map() ||
      (resolution.empty() && !of_all_sizes && name != "STEREO" && name != "MISC"))
    return unused.unknown.push_back(fmt::format("[{}]", name));
  if (!resolution.empty() && resolution != size.name)
    return unused.other_sizes.push_back(fmt::format("[{}]", name));
  const auto is_known = [&](std::string_view key) {
    if (of_all_sizes) return is_one_of(key, kCoefficients) || is_one_of(key, kThinPrism);
    if (name == "STEREO") return is_of_the_pose(key);
    if (name == "MISC") return key == "Sensor_ID";  // says nothing of the pictures
    return is_one_of(key, kPinhole) || is_one_of(key, kCoefficients) || is_one_of(key, kThinPrism);
  };
  for (const std::string& key : section.keys())
    if (!is_known(key)) unused.unknown.push_back(fmt::format("[{}] {}", name, key));
  const std::string all_sizes = fmt::format("{}_DISTO", name.substr(0, name.find('_')));
  if (!resolution.empty() && !found_in(section, kCoefficients).empty() &&
      !found_in(file.get(all_sizes), kCoefficients).empty())
    unused.older_lenses.push_back(fmt::format("[{}]", name));
}

}  // namespace

std::vector<std::string_view> found_in(const ConfigNode& section, Keys keys) {
  std::vector<std::string_view> out;
  std::ranges::copy_if(keys, std::back_inserter(out),
                       [&](std::string_view key) { return section.get(key).defined(); });
  return out;
}

void note_unused_sections(const ConfigNode& file, const Resolution& size,
                          const std::string& file_name, std::vector<std::string>& notes) {
  Unused unused;
  for (const std::string& name : file.keys()) look_for_unused(file, name, size, unused);
  std::vector<std::string> parts;
  const auto add = [&](const std::vector<std::string>& names, std::string_view why) {
    if (!names.empty()) parts.push_back(unused_part(names, why));
  };
  add(unused.unknown, "not understood");
  add(unused.other_sizes, "for pictures of other sizes");
  add(unused.older_lenses, "the coefficients there: those for all sizes are newer");
  if (!parts.empty())
    notes.push_back(fmt::format("{}: not used: {}", file_name, fmt::join(parts, "; ")));
}

}  // namespace hypotrack::calibration::internal
