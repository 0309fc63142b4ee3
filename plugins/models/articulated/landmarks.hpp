#pragma once

#include <string>
#include <vector>

#include "hypotrack/plugin/params.hpp"
#include "mechanism.hpp"

namespace hypotrack::articulated {

/// A point for the error that a scene names.
struct Anchor {
  std::string name;
  std::string link;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< in the link's frame, metres

  void visit(ParamVisitor& v);
};

/// Returns three landmarks per bone with vertices: those of the bounding box of what it moves, in
/// the bone's axes.
std::vector<Landmark> bounding_box_landmarks_of_bones(const ModelData& data);

/// Returns the anchors as landmarks. Throws DataError, beginning with `where`, on unknown links.
std::vector<Landmark> landmarks_of(const std::vector<Anchor>& anchors,
                                   const std::vector<std::string>& links, const Assembly& assembly,
                                   const std::string& where);

}  // namespace hypotrack::articulated
