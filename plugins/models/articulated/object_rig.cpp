#include "object_rig.hpp"

#include <array>

#include "hypotrack/api/config.hpp"

namespace hypotrack::articulated {

std::span<const std::string_view> enum_names(RigJointType) {
  static constexpr std::array<std::string_view, 3> kNames = {"revolute", "continuous", "prismatic"};
  return kNames;
}

void RigJoint::visit(ParamVisitor& v) {
  const auto degrees = [&](const char* key, double& value, const char* help) {
    v(key, value, {.help = help, .min = -36000, .max = 36000, .unit = "deg", .to_si = kDegree});
  };
  const auto millimetres = [&](const char* key, double& value, const char* help) {
    v(key, value, {.help = help, .min = -1e5, .max = 1e5, .unit = "mm", .to_si = kMillimetre});
  };
  v("name", name, {.help = "name of the parameter", .required = true});
  v("bone", bone, {.help = "bone of the file that it moves", .required = true});
  v("type", type, {.help = "turns within bounds, turns without end, or slides"});
  v("axis", axis, {.help = "direction in the bone's frame", .required = true});
  v("bounds_deg", bounds_deg,
    {.help = "lowest and highest angle", .min = -36000, .max = 36000, .to_si = kDegree});
  v("bounds_mm", bounds_mm,
    {.help = "lowest and highest length", .min = -1e5, .max = 1e5, .to_si = kMillimetre});
  degrees("rest_deg", rest_deg, "angle at rest");
  millimetres("rest_mm", rest_mm, "length at rest");
  degrees("bind_deg", bind_deg, "angle at which the file has the bone");
  millimetres("bind_mm", bind_mm, "length at which the file has the bone");
  v("mimic", mimic, {.help = "joint whose value this one follows"});
  v("multiplier", multiplier, {.help = "factor on that value", .min = -1e3, .max = 1e3});
  degrees("offset_deg", offset_deg, "added to that value");
  millimetres("offset_mm", offset_mm, "added to that value, if it slides");
}

void ObjectRig::visit(ParamVisitor& v) {
  v("scale", scale, {.help = "metres per unit of the file", .min = 1e-6, .max = 1e3});
  v("joints", joints, {.help = "which bones move, and how", .required = true});
}

ObjectRig read_object_rig(const std::filesystem::path& file) {
  return ParamReader(ConfigNode::load(file)).read<ObjectRig>();
}

}  // namespace hypotrack::articulated
