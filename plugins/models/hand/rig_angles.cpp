#include <fmt/format.h>

#include <algorithm>

#include "hand_parameters.hpp"
#include "rigging.hpp"

namespace hypotrack {
namespace {

Parameter& parameter(Rigging& r, int angle) {
  return r.data.parameters[pose_parameters().size() + static_cast<std::size_t>(angle)];
}

}  // namespace

void add_angles(Rigging& r) {
  for (const Parameter& angle : hand_angles()) r.data.parameters.push_back(angle);
  for (const RigParameter& given : r.rig.parameters) {
    Parameter& angle = parameter(r, r.angle_index(given.name, "`parameters`"));
    if (!given.bounds.empty()) {
      if (given.bounds.size() != 2 || !(given.bounds[0] < given.bounds[1])) {
        r.fail(fmt::format("`bounds_deg` of '{}' must be a lower and a higher value", given.name));
      }
      angle.lower = given.bounds[0];
      angle.upper = given.bounds[1];
    }
    angle.rest = std::clamp(given.rest.value_or(0), angle.lower, angle.upper);
    if (given.rest && angle.rest != *given.rest) {
      r.fail(fmt::format("`rest_deg` of '{}' is {:.6g}, outside its bounds {:.6g} .. {:.6g}",
                         given.name, *given.rest / kDegree, angle.lower / kDegree,
                         angle.upper / kDegree));
    }
    if (given.bind) r.bind[given.name] = *given.bind;
  }
}

void drive(Rigging& r, std::size_t index, const std::string& name, const Eigen::Vector3d& axis,
           double measured) {
  if (name.empty()) return;
  const RigBone& bone = r.rig.bones[index];
  const int angle = r.angle_index(name, who(bone));
  if (!r.driven.emplace(name, static_cast<int>(index)).second) {
    r.fail(fmt::format("the parameter '{}' turns both '{}' and '{}'", name,
                       r.rig_names[static_cast<std::size_t>(r.driven.at(name))], bone.name));
  }
  const auto bind = r.bind.find(name);
  r.data.motions.push_back({static_cast<int>(index),
                            static_cast<int>(pose_parameters().size()) + angle, axis.normalized(),
                            bind == r.bind.end() ? measured : bind->second, 1});
}

}  // namespace hypotrack
