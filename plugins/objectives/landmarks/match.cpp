#include "match.hpp"

#include <algorithm>
#include <tuple>

namespace hypotrack::landmarks {
namespace {

/// A model and a detection that may belong together.
struct Pair {
  double angle;
  std::size_t wanted, seen;
};

bool may_be(const WantedHand& wanted, const SeenHand& seen, double angle) {
  constexpr double kFarthest = 1;  // times the hand's apparent size
  const double side = wanted.right ? seen.right : 1 - seen.right;
  return side >= 0.5 && angle <= kFarthest * std::max(apparent_size(wanted.directions),
                                                      apparent_size(seen.directions));
}

}  // namespace

std::vector<std::optional<SeenHand>> match(std::span<const WantedHand> wanted,
                                           std::span<const SeenHand> seen) {
  std::vector<Pair> pairs;
  for (std::size_t w = 0; w < wanted.size(); ++w) {
    for (std::size_t s = 0; s < seen.size(); ++s) {
      const double angle = mean_angle(wanted[w].directions, seen[s].directions);
      if (may_be(wanted[w], seen[s], angle)) pairs.push_back({angle, w, s});
    }
  }
  std::ranges::sort(pairs, {}, [](const Pair& p) { return std::tuple(p.angle, p.wanted, p.seen); });
  std::vector<std::optional<SeenHand>> out(wanted.size());
  std::vector<bool> taken(seen.size());
  for (const Pair& pair : pairs) {
    if (out[pair.wanted] || taken[pair.seen]) continue;
    out[pair.wanted] = seen[pair.seen];
    taken[pair.seen] = true;
  }
  return out;
}

bool overlap(const HandPoints3D& a, const HandPoints3D& b) {
  constexpr double kShare = 0.5;  // of the larger hand's apparent size, between their centres
  return (center_of(a) - center_of(b)).norm() <
         kShare * std::max(apparent_size(a), apparent_size(b));
}

bool same_hand(const SeenHand& a, const SeenHand& b) {
  constexpr double kShare = 0.2;  // of the hand's apparent size
  return mean_angle(a.directions, b.directions) <
         kShare * std::max(apparent_size(a.directions), apparent_size(b.directions));
}

}  // namespace hypotrack::landmarks
