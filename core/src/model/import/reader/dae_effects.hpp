#pragma once

#include <array>
#include <boost/property_tree/ptree.hpp>
#include <map>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "model/import/wire.hpp"

namespace hypotrack::mesh_wire {
inline namespace HYPOTRACK_EXPORTED internal {

using Xml = boost::property_tree::ptree;

/// Returns an attribute of an element; an empty text if there is none.
std::string attribute(const Xml& element, const std::string& name);

/// The settings of a COLLADA effect that assimp leaves out.
struct Effect {
  std::array<Wrap, 2> wrap{};
  std::string coordinates{};  // name of those of its picture
  bool glows = false;         // its emission is its only colour
  std::array<float, 3> emission{};
  std::vector<std::string> left_out{};
};

/// The effects of a COLLADA file by the materials that use them.
class Effects {
 public:
  explicit Effects(const Xml& root);

  /// Returns the effect of a material as assimp names it; null if there is none.
  const Effect* of(const std::string& material) const;
  /// Returns the set of texture coordinates of a material's picture, which its instances bind by
  /// name.
  unsigned set_of(const std::string& material) const;

 private:
  void find_sets(const Xml& element);

  std::map<std::string, Effect> of_materials_;
  std::map<std::string, std::string> names_;  // of materials, by their references
  std::map<std::string, unsigned> sets_;      // by the names of materials
};

}  // namespace internal
}  // namespace hypotrack::mesh_wire
