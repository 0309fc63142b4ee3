#include "finger_pair.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "hypotrack/api/scene.hpp"

namespace hypotrack::rgbd_depth {
namespace {

constexpr std::array<std::string_view, 4> kFingers = {"index", "middle", "ring", "little"};

std::optional<int> find(const Scene& scene, const std::string& name) {
  const auto& all = scene.parameters();
  const auto found = std::ranges::find(all, name, &Parameter::name);
  if (found == all.end()) return std::nullopt;
  return static_cast<int>(found - all.begin());
}

}  // namespace

std::vector<FingerPair> adjacent_fingers(const Scene& scene) {
  std::vector<FingerPair> pairs;
  for (const Scene::Item& item : scene.items()) {
    std::optional<int> before;
    for (const std::string_view finger : kFingers) {
      const auto here = find(scene, item.name + "." + std::string(finger) + "_abduction");
      if (before && here) pairs.push_back({*before, *here});
      before = here;
    }
  }
  return pairs;
}

}  // namespace hypotrack::rgbd_depth
