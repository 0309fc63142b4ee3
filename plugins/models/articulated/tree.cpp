#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <set>

#include "hypotrack/api/error.hpp"
#include "mechanism.hpp"

namespace hypotrack::articulated {
namespace {

/// The joints of a mechanism by the links that they join.
class Links {
 public:
  Links(const Mechanism& mechanism, const std::string& where)
      : mechanism_(mechanism), where_(where) {
    for (std::size_t i = 0; i < mechanism.links.size(); ++i) {
      if (!index_.emplace(mechanism.links[i], i).second)
        fail(fmt::format("two links are called '{}'; give each a name of its own",
                         mechanism.links[i]));
    }
    std::set<std::string> names;
    for (const Joint& joint : mechanism.joints) {
      if (!names.insert(joint.name).second)
        fail(fmt::format("two joints are called '{}'; give each a name of its own", joint.name));
      below_[index_of(joint.parent, joint)].push_back(&joint);
      const auto [above, is_first] = above_.emplace(index_of(joint.child, joint), &joint);
      if (!is_first)
        fail(
            fmt::format("the link '{}' is the child of both joint '{}' and joint '{}': closed "
                        "loops are not supported; leave one of the joints out",
                        joint.child, above->second->name, joint.name));
    }
  }

  std::vector<TreeLink> in_order() const {
    std::vector<TreeLink> order{{root()}};
    for (std::size_t i = 0; i < order.size(); ++i) {
      const auto below = below_.find(order[i].link);
      if (below == below_.end()) continue;
      for (const Joint* joint : below->second)
        order.push_back({index_.at(joint->child), static_cast<int>(i), joint});
    }
    check_all_reached(order);
    return order;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw DataError(where_ + ": " + what); }

  std::size_t index_of(const std::string& link, const Joint& joint) const {
    const auto found = index_.find(link);
    if (found == index_.end())
      fail(fmt::format("joint '{}' joins the link '{}', which there is not; the links are: {}",
                       joint.name, link, fmt::join(mechanism_.links, ", ")));
    return found->second;
  }

  std::size_t root() const {
    std::vector<std::string> roots;
    for (std::size_t i = 0; i < mechanism_.links.size(); ++i)
      if (!above_.contains(i)) roots.push_back(mechanism_.links[i]);
    if (roots.empty())
      fail("every link is the child of another: a cycle of joints; leave one of them out");
    if (roots.size() > 1)
      fail(
          fmt::format("the links '{}' are children of no joint; expected one root: join the "
                      "others to it, with joints of type fixed if they do not move",
                      fmt::join(roots, "', '")));
    return index_.at(roots.front());
  }

  void check_all_reached(const std::vector<TreeLink>& order) const {
    if (order.size() == mechanism_.links.size()) return;
    std::set<std::string> left(mechanism_.links.begin(), mechanism_.links.end());
    for (const TreeLink& link : order) left.erase(mechanism_.links[link.link]);
    fail(
        fmt::format("the links '{}' hang on each other in a cycle of joints; leave one of these "
                    "joints out",
                    fmt::join(left, "', '")));
  }

  const Mechanism& mechanism_;
  const std::string& where_;
  std::map<std::string, std::size_t> index_;
  std::map<std::size_t, const Joint*> above_;               // by child link
  std::map<std::size_t, std::vector<const Joint*>> below_;  // by parent link
};

}  // namespace

std::vector<TreeLink> order_links(const Mechanism& mechanism, const std::string& where) {
  return Links(mechanism, where).in_order();
}

}  // namespace hypotrack::articulated
