#include "rig.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>

#include "hypotrack/api/config.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/text.hpp"

namespace hypotrack {

std::span<const std::string_view> enum_names(Side) {
  static constexpr std::array<std::string_view, 2> kNames = {"right", "left"};
  return kNames;
}

void RigFrame::visit(ParamVisitor& v) {
  v("origin", origin, {.help = "file bone at the hand frame's origin; default: the root's joint"});
  v("x", x, {.help = "file axis that is the hand's +X (radial): x, -x, y, -y, z or -z"});
  v("y", y, {.help = "file axis that is the hand's +Y (distal)"});
  v("distal", distal, {.help = "instead of axes: file bone that +Y points to"});
  v("radial", radial, {.help = "two file bones: +X points from the first to the second"});
}

void RigBone::visit(ParamVisitor& v) {
  v("name", name, {.help = "name of the bone", .required = true});
  v("parent", parent, {.help = "an earlier bone; the first bone has none"});
  v("joint", joint, {.help = "file bone at whose origin it begins"});
  v("joint_at", joint_at, {.help = "or the point itself, in the file's units"});
  v("end", end, {.help = "file bone that it points to; default: its farthest vertex"});
  v("end_at", end_at, {.help = "or the point itself, in the file's units"});
  v("weights", weights, {.help = "file bones whose vertices it moves; default: `joint`"});
  v("flexion_axis", flexion_axis,
    {.help = "its +X: hand, bend, or an axis of the file bone; default: the rig's"});
  v("twist_deg", twist,
    {.help = "turns the flexion axis about +Y", .min = -180, .max = 180, .to_si = kDegree});
  v("zero_deg", zero,
    {.help = "abduction, twist, flexion at which it stands when all angles are zero",
     .min = -180,
     .max = 180,
     .to_si = kDegree});
  v("abduction", abduction, {.help = "parameter that abducts it"});
  v("flexion", flexion, {.help = "parameter that flexes it"});
}

void RigParameter::visit(ParamVisitor& v) {
  v("name", name, {.help = "one of the 20 angles", .required = true});
  v("bounds_deg", bounds,
    {.help = "lowest and highest value", .min = -180, .max = 180, .to_si = kDegree});
  v("rest_deg", rest, {.help = "resting value", .min = -180, .max = 180, .to_si = kDegree});
  v("bind_deg", bind,
    {.help = "value at which the bone stands as in the file; default: measured",
     .min = -180,
     .max = 180,
     .to_si = kDegree});
}

void RigLandmark::visit(ParamVisitor& v) {
  v("name", name, {.help = "one of the 21 landmarks", .required = true});
  v("bone", bone, {.help = "bone that carries it", .required = true});
  v("position_mm", position,
    {.help = "x radial, y distal, z palmar from the bone's joint", .to_si = kMillimetre});
}

void Rig::visit(ParamVisitor& v) {
  v("side", side, {.help = "side of the hand in the file"});
  v("scale", scale, {.help = "metres per unit of the file", .min = 1e-6, .max = 1e3});
  v("frame", frame, {.help = "where the hand frame lies in the file"});
  v("flexion_axis", flexion_axis, {.help = "where bones have their +X from"});
  v("bones", bones, {.help = "bones, parents before children"});
  v("parameters", parameters, {.help = "what differs from the anatomical defaults"});
  v("landmarks", landmarks, {.help = "what differs from joints and bone ends"});
  v("cut_mm", cut,
    {.help = "cuts the arm off this far proximal of the origin",
     .min = -50,
     .max = 500,
     .to_si = kMillimetre});
}

Rig read_rig(const std::filesystem::path& file) {
  return ParamReader(ConfigNode::load(file)).read<Rig>();
}

std::string hint_about(const std::string& name, const std::vector<std::string>& known) {
  const std::string hint = did_you_mean(name, known);
  return hint.empty() ? fmt::format("; there are: {}", fmt::join(known, ", ")) : hint;
}

}  // namespace hypotrack
