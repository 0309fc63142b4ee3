#include "drives.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "hypotrack/api/error.hpp"

namespace hypotrack::articulated {

Drives::Drives(const std::vector<Joint>& joints, const std::string& where)
    : where_(where), parameters_(pose_parameters()) {
  for (const Joint& joint : joints)
    if (joint.kind != JointKind::fixed) joints_.emplace(joint.name, &joint);
  for (const Joint& joint : joints) {
    if (joint.kind == JointKind::fixed) continue;
    if (joint.mimic) {
      check_mimicked(joint);
    } else {
      add_parameter(joint);
    }
  }
}

void Drives::fail(const std::string& what) const { throw DataError(where_ + ": " + what); }

void Drives::add_parameter(const Joint& joint) {
  // Negated, so that NaN fails.
  if (!(joint.lower < joint.upper))
    fail(
        fmt::format("joint '{}' has the limits {} to {}, which leave it no room; expected a lower "
                    "and a higher one, or the type fixed",
                    joint.name, joint.lower, joint.upper));
  index_.emplace(joint.name, static_cast<int>(parameters_.size()));
  const bool slides = joint.kind == JointKind::prismatic;
  parameters_.push_back({joint.name, slides ? ParameterKind::length : ParameterKind::angle,
                         joint.lower, joint.upper,
                         std::clamp(joint.rest, joint.lower, joint.upper)});
}

void Drives::check_mimicked(const Joint& joint) const {
  std::set<const Joint*> seen;
  for (const Joint* at = &joint; at->mimic;) {
    if (!seen.insert(at).second)
      fail(fmt::format("joint '{}' mimics itself by way of others; let one of them be free",
                       joint.name));
    if (!std::isfinite(at->mimic->multiplier) || !std::isfinite(at->mimic->offset))
      fail(fmt::format("joint '{}' mimics another with a number that is not finite", at->name));
    const auto next = joints_.find(at->mimic->joint);
    if (next == joints_.end()) {
      std::vector<std::string> known;
      for (const auto& [name, its] : joints_)
        if (!its->mimic) known.push_back(name);
      fail(
          fmt::format("joint '{}' mimics '{}', which is no joint that moves; those that can be "
                      "mimicked are: {}",
                      at->name, at->mimic->joint,
                      known.empty() ? "none" : fmt::format("{}", fmt::join(known, ", "))));
    }
    at = next->second;
  }
}

Drive Drives::of(const Joint& joint) const {
  Drive drive;
  const Joint* at = &joint;
  for (; at->mimic; at = joints_.at(at->mimic->joint)) {
    drive.offset += drive.multiplier * at->mimic->offset;
    drive.multiplier *= at->mimic->multiplier;
  }
  drive.parameter = index_.at(at->name);
  return drive;
}

}  // namespace hypotrack::articulated
