#include "hand_parameters.hpp"

#include <array>
#include <string_view>

#include "hypotrack/plugin/params.hpp"

namespace hypotrack {
namespace {

struct Range {
  double lower_deg;
  double upper_deg;
};

// Ranges of motion in degrees. Flexion, and finger abduction, from
//   [L] J. Lin, Y. Wu, T. S. Huang, "Modeling the constraints of human hand motion", HUMO 2000:
//       MCP flexion 0..90, PIP 0..110, DIP 0..90, MCP abduction -15..15;
// extension beyond straight, and the thumb's MCP and IP joints, from
//   [A] American Academy of Orthopaedic Surgeons, "Joint Motion: Method of Measuring and
//   Recording",
//       1965: fingers MCP extension up to 45 (we allow the active part), DIP 10; thumb MCP flexion
//       50, IP flexion 80 and extension 20, CMC abduction 70;
// the trapeziometacarpal joint from
//   [C] W. P. Cooney et al., "The kinesiology of the thumb trapeziometacarpal joint", J. Bone Joint
//       Surg. 63-A, 1981: flexion-extension 53, abduction-adduction 42.
// The thumb's zero is the plane of the palm (rig.hpp), where it is adducted: its abduction runs
// from there. The index and the little finger reach farther outwards than [L] has it: 20 to 25
// degrees in C. Hume et al., "Functional range of motion of the joints of the hand", J. Hand Surg.
// 15-A, 1990, and in the postures of the hand models in use.
constexpr Range kMcp{-25, 90};
constexpr Range kPip{-5, 110};
constexpr Range kDip{-10, 90};
constexpr std::array<Range, 4> kThumb = {{{-10, 60}, {-25, 40}, {-10, 60}, {-20, 80}}};
constexpr std::array<std::string_view, 4> kFingers = {"index", "middle", "ring", "little"};
constexpr std::array<Range, 4> kAbduction = {{{-15, 25}, {-15, 15}, {-20, 15}, {-30, 15}}};

Parameter angle(std::string name, const Range& range) {
  return {std::move(name), ParameterKind::angle, range.lower_deg * kDegree,
          range.upper_deg * kDegree, 0};
}

std::vector<Parameter> make_angles() {
  std::vector<Parameter> angles;
  angles.push_back(angle("thumb_abduction", kThumb[0]));
  for (std::size_t i = 1; i < kThumb.size(); ++i) {
    angles.push_back(angle("thumb_flexion_" + std::to_string(i), kThumb[i]));
  }
  for (std::size_t f = 0; f < kFingers.size(); ++f) {
    const std::string finger(kFingers[f]);
    angles.push_back(angle(finger + "_abduction", kAbduction[f]));
    angles.push_back(angle(finger + "_flexion_1", kMcp));
    angles.push_back(angle(finger + "_flexion_2", kPip));
    angles.push_back(angle(finger + "_flexion_3", kDip));
  }
  return angles;
}

std::vector<std::string> make_landmarks() {
  std::vector<std::string> names = {"wrist", "thumb_cmc", "thumb_mcp", "thumb_ip", "thumb_tip"};
  for (const std::string_view finger : kFingers) {
    for (const char* joint : {"_mcp", "_pip", "_dip", "_tip"}) {
      names.push_back(std::string(finger) + joint);
    }
  }
  return names;
}

}  // namespace

const std::vector<Parameter>& hand_angles() {
  static const std::vector<Parameter> angles = make_angles();
  return angles;
}

const std::vector<std::string>& hand_landmarks() {
  static const std::vector<std::string> names = make_landmarks();
  return names;
}

std::string driving_flexion(const std::string& landmark) {
  const std::size_t split = landmark.find('_');
  if (split == std::string::npos) return {};
  const std::string finger = landmark.substr(0, split);
  const std::string joint = landmark.substr(split + 1);
  const bool thumb = finger == "thumb";
  const std::array<std::string_view, 3> joints =
      thumb ? std::array<std::string_view, 3>{"cmc", "mcp", "ip"}
            : std::array<std::string_view, 3>{"mcp", "pip", "dip"};
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (joint == joints[i]) return finger + "_flexion_" + std::to_string(i + 1);
  }
  return {};
}

std::string last_flexion(const std::string& landmark) {
  constexpr std::string_view kTip = "_tip";
  if (!landmark.ends_with(kTip)) return {};
  return landmark.substr(0, landmark.size() - kTip.size()) + "_flexion_3";
}

}  // namespace hypotrack
