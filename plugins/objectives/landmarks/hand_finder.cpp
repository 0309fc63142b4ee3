#include "hand_finder.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace hypotrack::landmarks {
namespace {

// Views of frames: 68 seconds of two cameras at 30 frames per second. Fixed-lag smoothing goes
// through all of its window again and again, 20 seconds by default.
constexpr std::size_t kRemembered = 4096;

bool all_found(const std::vector<std::optional<SeenHand>>& hands) {
  return std::ranges::all_of(hands, [](const auto& hand) { return hand.has_value(); });
}

}  // namespace

std::vector<std::optional<SeenHand>> HandFinder::find(const Observation& observation,
                                                      std::size_t view,
                                                      std::span<const ModelHand> models) {
  const TileView& tile = observation.views[view];
  std::vector<WantedHand> wanted;
  for (const ModelHand& model : models)
    wanted.push_back({directions_to(model.start, tile.camera), model.right});
  Seen& seen = known(observation, view);
  std::vector<std::optional<SeenHand>> found = match(wanted, seen.hands);
  const Part part = part_of(tile.camera);
  if (all_found(found) || searched(seen, part)) return found;
  seen.searched.push_back(part);
  const std::vector<std::optional<SeenHand>> before = last(observation, view, models);
  std::vector<std::optional<HandDetection>> looked(models.size());
  tbb::parallel_for(std::size_t{0}, models.size(), [&](std::size_t i) {
    if (!found[i]) looked[i] = look(tile, models[i], before[i]);
  });
  for (const auto& hand : looked)
    if (hand) add(seen, *hand, tile.camera);
  found = match(wanted, seen.hands);
  if (all_found(found)) return found;
  for (const HandDetection& hand : detector_.detect(tile.color)) add(seen, hand, tile.camera);
  return match(wanted, seen.hands);
}

bool HandFinder::saw_other_side(const Observation& observation, std::size_t view,
                                const ModelHand& model) {
  constexpr double kSurely = 0.8;
  const SeenHand own{.directions = directions_to(model.start, observation.views[view].camera)};
  return std::ranges::any_of(known(observation, view).hands, [&](const SeenHand& seen) {
    return (model.right ? 1 - seen.right : seen.right) >= kSurely && same_hand(own, seen);
  });
}

std::vector<std::optional<SeenHand>> HandFinder::last(const Observation& observation,
                                                      std::size_t view,
                                                      std::span<const ModelHand> models) {
  std::vector<std::optional<SeenHand>> out(models.size());
  const auto& previous = observation.context.previous;
  if (!previous) return out;
  std::vector<SeenHand> hands;
  {
    const std::lock_guard lock(mutex_);
    const auto found = std::ranges::find_if(seen_, [&](const Seen& seen) {
      return seen.frame == previous->frame && seen.time == previous->time && seen.view == view;
    });
    if (found == seen_.end()) return out;
    hands = found->hands;
  }
  std::vector<WantedHand> wanted;
  for (const ModelHand& model : models) {
    if (!model.previous) return out;
    wanted.push_back({directions_to(*model.previous, observation.views[view].camera), model.right});
  }
  return match(wanted, hands);
}

std::optional<HandDetection> HandFinder::look(const TileView& tile, const ModelHand& model,
                                              const std::optional<SeenHand>& last) const {
  const HandPoints start = in_tile(model.start, tile.camera);
  if (last && model.previous) {
    const HandPoints guess =
        moved(in_tile(*last, tile.camera), in_tile(*model.previous, tile.camera), start);
    if (guess.allFinite()) return detector_.refine(tile.color, guess, true);
  }
  return detector_.refine(tile.color, start, false);
}

HandFinder::Part HandFinder::part_of(const TileCamera& camera) {
  const Eigen::Vector3d ray(((camera.width - 1) / 2.0 - camera.cx) / camera.fx,
                            ((camera.height - 1) / 2.0 - camera.cy) / camera.fy, 1);
  return {camera.camera_from_world.linear().transpose() * ray.normalized(),
          std::max(camera.width / camera.fx, camera.height / camera.fy) / ray.squaredNorm()};
}

bool HandFinder::searched(const Seen& seen, const Part& part) {
  constexpr double kShift = 0.15, kScale = 1.25;  // of sides
  return std::ranges::any_of(seen.searched, [&](const Part& other) {
    return (part.center - other.center).norm() < kShift * other.side &&
           part.side < kScale * other.side && other.side < kScale * part.side;
  });
}

HandFinder::Seen& HandFinder::known(const Observation& observation, std::size_t view) {
  const std::lock_guard lock(mutex_);
  const auto found = std::ranges::find_if(seen_, [&](const Seen& seen) {
    return seen.frame == observation.frame && seen.time == observation.time && seen.view == view;
  });
  if (found != seen_.end()) return *found;
  if (seen_.size() == kRemembered) seen_.pop_front();
  return seen_.emplace_back(Seen{observation.frame, observation.time, view});
}

void HandFinder::add(Seen& seen, const HandDetection& detection, const TileCamera& camera) {
  const SeenHand hand = seen_hand(detection, camera);
  if (!hand.directions.allFinite() || !std::isfinite(hand.distance) || !(hand.distance > 0)) return;
  const bool is_known = std::ranges::any_of(
      seen.hands, [&](const SeenHand& other) { return same_hand(hand, other); });
  if (!is_known) seen.hands.push_back(hand);
}

}  // namespace hypotrack::landmarks
