#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "hand_parameters.hpp"
#include "rig.hpp"
#include "rigging.hpp"

namespace hypotrack {
namespace {

Landmark default_landmark(const Rigging& r, const std::string& name) {
  if (const std::string flexion = driving_flexion(name); !flexion.empty()) {
    return {name, r.driven.at(flexion), Eigen::Vector3d::Zero()};
  }
  if (const std::string flexion = last_flexion(name); !flexion.empty()) {
    const int bone = r.driven.at(flexion);
    const auto i = static_cast<std::size_t>(bone);
    return {name, bone, r.hand_from_bone[i].inverse() * r.ends[i]};
  }
  return {name, 0, Eigen::Vector3d::Zero()};
}

void check_all_driven(const Rigging& r) {
  for (const std::string& name : r.angle_names) {
    if (!r.driven.contains(name)) {
      r.fail(fmt::format("no bone is turned by the parameter '{}'; a hand has all of its 20 angles",
                         name));
    }
  }
}

std::map<std::string, const RigLandmark*> replaced_landmarks(const Rigging& r) {
  std::map<std::string, const RigLandmark*> given;
  for (const RigLandmark& landmark : r.rig.landmarks) {
    const auto& known = hand_landmarks();
    if (std::find(known.begin(), known.end(), landmark.name) == known.end()) {
      r.fail(fmt::format("`landmarks` names '{}', which a hand does not have{}", landmark.name,
                         hint_about(landmark.name, known)));
    }
    given[landmark.name] = &landmark;
  }
  return given;
}

}  // namespace

void add_landmarks(Rigging& r) {
  check_all_driven(r);
  const auto given = replaced_landmarks(r);
  for (const std::string& name : hand_landmarks()) {
    const auto replaced = given.find(name);
    r.data.landmarks.push_back(
        replaced == given.end()
            ? default_landmark(r, name)
            : Landmark{name, r.rig_bone(replaced->second->bone, "landmark '" + name + "'"),
                       replaced->second->position});
  }
}

}  // namespace hypotrack
