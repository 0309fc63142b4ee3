#pragma once

#include <string>
#include <vector>

#include "mechanism.hpp"

namespace hypotrack::articulated {

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
