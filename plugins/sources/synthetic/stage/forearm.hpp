#pragma once

#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "hypotrack/plugin/model.hpp"
#include "hypotrack/plugin/params.hpp"

namespace hypotrack::synthetic {

enum class ForearmKind { none, bare, sleeve };
inline std::span<const std::string_view> enum_names(ForearmKind) {
  static constexpr std::array<std::string_view, 3> kNames = {"none", "bare", "sleeve"};
  return kNames;
}

struct ForearmParams {
  ForearmKind kind = ForearmKind::none;
  std::vector<double> color;
  double length = 350 * kMillimetre;
  void visit(ParamVisitor& v) {
    v("kind", kind, {.help = "none, a bare arm, or an arm in a sleeve"});
    v("color", color,
      {.help = "red, green, blue; default: of the skin at the wrist, a black sleeve",
       .min = 0,
       .max = 255});
    v("length_mm", length,
      {.help = "behind the wrist", .min = 20, .max = 2000, .unit = "mm", .to_si = kMillimetre});
  }
};

/// Returns the mean colour of a hand's skin at its wrist: red, green, blue, up to 255.
Eigen::Vector3d skin_color(const ModelData& hand, int wrist_bone);

/// Makes a forearm: a tapered elliptic tube that continues a hand's mesh, in the frame of the bone
/// at its wrist (hand axes: y distal). It is a rigid model, as wide as the mesh at its end. Throws
/// ConfigError unless `color` has no number or three.
ModelData make_forearm(const ModelData& hand, int wrist_bone, const ForearmParams& params);

}  // namespace hypotrack::synthetic
