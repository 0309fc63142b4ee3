#include <fmt/format.h>
#include <fmt/ranges.h>

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <map>
#include <set>
#include <sstream>

#include "urdf_text.hpp"

namespace hypotrack::articulated {
namespace {

using Xml = boost::property_tree::ptree;
using Names = std::set<std::string, std::less<>>;

/// The elements and attributes that an element may have, and which of them mean nothing here.
struct Grammar {
  Names attributes, elements, unused{};
};

/// Returns the grammar of URDF 1.0 (wiki.ros.org/urdf/XML) without what moves nothing and is not
/// drawn: masses, collision geometry, friction, calibration.
const std::map<std::string, Grammar, std::less<>>& grammar() {
  static const std::map<std::string, Grammar, std::less<>> all = {
      {"robot", {{"name", "version"}, {"link", "joint", "material"}}},
      {"link", {{"name"}, {"visual"}, {"collision", "inertial"}}},
      {"joint",
       {{"name", "type"},
        {"parent", "child", "origin", "axis", "limit", "mimic"},
        {"dynamics", "calibration"}}},
      {"visual", {{"name"}, {"origin", "geometry", "material"}}},
      {"geometry", {{}, {"box", "cylinder", "sphere", "mesh"}}},
      {"material", {{"name"}, {"color", "texture"}}},
      {"origin", {{"xyz", "rpy"}, {}}},
      {"box", {{"size"}, {}}},
      {"cylinder", {{"radius", "length"}, {}}},
      {"sphere", {{"radius"}, {}}},
      {"mesh", {{"filename", "scale"}, {}}},
      {"color", {{"rgba"}, {}}},
      {"texture", {{"filename"}, {}}},
      {"parent", {{"link"}, {}}},
      {"child", {{"link"}, {}}},
      {"axis", {{"xyz"}, {}}},
      {"limit", {{"lower", "upper", "effort", "velocity"}, {}}},
      {"mimic", {{"joint", "multiplier", "offset"}, {}}},
  };
  return all;
}

/// Counts what a file has that is not read.
class Unread {
 public:
  void look_at(const std::string& name, const Xml& element) {
    const auto found = grammar().find(name);
    if (found == grammar().end()) return;
    for (const auto& [child_name, child] : element) {
      if (child_name == "<xmlattr>") {
        look_at_attributes(name, found->second, child);
      } else if (found->second.elements.contains(child_name)) {
        look_at(child_name, child);
      } else if (!found->second.unused.contains(child_name)) {
        ++counts_["<" + child_name + ">"];
      }
    }
  }

  std::vector<std::string> words() const {
    std::vector<std::string> out;
    for (const auto& [what, count] : counts_)
      out.push_back(count == 1 ? what : fmt::format("{} ({} times)", what, count));
    return out;
  }

 private:
  void look_at_attributes(const std::string& name, const Grammar& known, const Xml& attributes) {
    for (const auto& [attribute, value] : attributes) {
      if (attribute.starts_with("xmlns")) continue;
      if (!known.attributes.contains(attribute))
        ++counts_[fmt::format("the attribute {} of <{}>", attribute, name)];
      if (attribute == "rgba" && is_transparent(value.data()))
        ++counts_["the transparency of <color>"];
    }
  }

  static bool is_transparent(const std::string& rgba) {
    std::istringstream in(rgba);
    double number = 1;
    for (int i = 0; i < 4; ++i) in >> number;
    return in && number < 1;
  }

  std::map<std::string, int> counts_;
};

}  // namespace

std::vector<std::string> unread_in_urdf(const std::string& text) {
  namespace tree = boost::property_tree;
  Xml root;
  try {
    std::istringstream in(text);
    tree::read_xml(in, root, tree::xml_parser::no_comments);
  } catch (const tree::xml_parser_error& error) {
    return {fmt::format("what is not read of it cannot be listed: line {}: {}", error.line(),
                        error.message())};
  }
  Unread unread;
  for (const auto& [name, element] : root) unread.look_at(name, element);
  const std::vector<std::string> words = unread.words();
  if (words.empty()) return {};
  return {fmt::format("not read: {}", fmt::join(words, ", "))};
}

}  // namespace hypotrack::articulated
