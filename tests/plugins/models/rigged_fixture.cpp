#include "rigged_fixture.hpp"

#include <gtest/gtest.h>

#include <array>

#include "hypotrack/api/error.hpp"

namespace hypotrack::test {
namespace {

constexpr std::array<const char*, 5> kFingers = {"thumb", "index", "middle", "ring", "little"};

}  // namespace

std::string stick_rig() {
  std::string yaml =
      "frame: {origin: wrist, x: x, y: y}\n"
      "flexion_axis: x\n"
      "bones:\n"
      "  - {name: wrist, joint: wrist}\n";
  for (const std::string finger : kFingers) {
    for (int k = 1; k <= 3; ++k) {
      const std::string name = finger + "_" + std::to_string(k);
      const std::string next = k == 3 ? finger + "_tip" : finger + "_" + std::to_string(k + 1);
      yaml += "  - {name: " + name +
              ", parent: " + (k == 1 ? "wrist" : finger + "_" + std::to_string(k - 1)) +
              ", joint: " + name + ", end: " + next + ", flexion: " + finger + "_flexion_" +
              std::to_string(k);
      if (k == 1) yaml += ", abduction: " + finger + "_abduction";
      if (k == 3) yaml += ", weights: [" + name + ", " + finger + "_tip]";
      if (name == "thumb_1") yaml += ", zero_deg: [45, -60, 0]";
      yaml += "}\n";
    }
  }
  return yaml;
}

Rig parse_rig(const std::string& yaml) {
  return ParamReader(ConfigNode::parse(yaml, "stick.yaml")).read<Rig>();
}

std::string rig_error(const std::string& yaml) {
  try {
    rig_hand(stick_hand(), parse_rig(yaml), "stick.yaml");
  } catch (const Error& error) {
    return error.what();
  }
  ADD_FAILURE() << "no error from:\n" << yaml;
  return {};
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) {
    ADD_FAILURE() << "no '" << from << "' in:\n" << text;
    return text;
  }
  return text.replace(at, from.size(), to);
}

}  // namespace hypotrack::test
