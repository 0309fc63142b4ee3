#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "hypotrack/plugin/model.hpp"

namespace hypotrack::articulated {

enum class JointKind { fixed, revolute, continuous, prismatic };

/// The value of a joint as that of another: multiplier * value + offset.
struct Mimic {
  std::string joint;
  double multiplier = 1;
  double offset = 0;  ///< radians or metres
};

/// A joint between two links. Values are radians, or metres if it slides.
struct Joint {
  std::string name;
  JointKind kind = JointKind::fixed;
  std::string parent{}, child{};                                        ///< links
  Eigen::Isometry3d parent_from_child = Eigen::Isometry3d::Identity();  ///< at the value `bind`
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  ///< in the child's frame; any length but 0
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  double rest = 0;  ///< moved into the limits
  double bind = 0;  ///< value at which the file has the joint
  std::optional<Mimic> mimic{};
};

/// Links and the joints between them: a tree, once assemble() has checked it.
struct Mechanism {
  std::vector<std::string> links;
  std::vector<Joint> joints;
};

/// The place of a link in a skeleton.
struct LinkPlace {
  int bone = 0;
  Eigen::Isometry3d bone_from_link = Eigen::Isometry3d::Identity();
};

/// A skeleton, at first without a surface, and the places of a mechanism's links in it.
struct Assembly {
  ModelData data;  ///< bones, parameters and motions
  std::vector<LinkPlace> links;
};

/// Makes a bone of every link that a joint moves; links that are fixed to another share its bone.
/// Every joint that mimics no other is a parameter of its name. Throws DataError, beginning with
/// `where`, unless the links are a tree with one root and every joint can be moved.
Assembly assemble(const Mechanism& mechanism, const std::string& where);

/// A link in the order of a tree: parents before their children.
struct TreeLink {
  std::size_t link;              ///< index into Mechanism::links
  int parent = -1;               ///< index of an earlier entry of the order; -1: the root
  const Joint* joint = nullptr;  ///< that joins it to its parent; null: the root
};

/// Orders the links from the root on. Throws DataError, beginning with `where`, unless they are a
/// tree: joints between known links, one parent each, one root, no cycles.
std::vector<TreeLink> order_links(const Mechanism& mechanism, const std::string& where);

}  // namespace hypotrack::articulated
