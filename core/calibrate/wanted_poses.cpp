#include "calibrate/wanted_poses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hypotrack::calibrate {
namespace {

void want_places(PoseCoverage& out, std::size_t view) {
  const char* name = view == 0 ? "left" : "right";
  const Coverage& coverage = out.pictures[view];
  for (const std::string& place : coverage.empty)
    out.wanted.push_back(fmt::format("board into the {} of the {} picture", place, name));
  if (coverage.empty.empty() && coverage.share < kEnoughCoverage)
    out.wanted.push_back(fmt::format("board to new places of the {} picture", name));
}

void want_tilts(PoseCoverage& out, const std::vector<RoughPose>& poses) {
  const double least = std::sin(18 * std::numbers::pi / 180);
  const std::array<std::pair<const char*, Eigen::Vector3d>, PoseCoverage::kTilts> directions = {
      {{"top", {0, -1, 0}}, {"bottom", {0, 1, 0}}, {"left", {-1, 0, 0}}, {"right", {1, 0, 0}}}};
  for (const auto& [side, direction] : directions) {
    const auto tilted = [&, &direction = direction](const RoughPose& pose) {
      return pose.normal.dot(direction) > least;
    };
    if (std::ranges::any_of(poses, tilted))
      ++out.tilts;
    else
      out.wanted.push_back(fmt::format("tilt the board by 30 degrees, its {} away", side));
  }
}

void want_distances(PoseCoverage& out, const std::vector<RoughPose>& poses) {
  constexpr double kNearExtent = 0.35, kRatio = 1.3;
  if (std::ranges::none_of(poses, [](const RoughPose& p) { return p.extent > kNearExtent; }))
    out.wanted.emplace_back("board nearer, so that it fills a third of the picture");
  const auto [nearest, farthest] = std::ranges::minmax_element(poses, {}, &RoughPose::distance);
  if (nearest == poses.end() || farthest->distance < kRatio * nearest->distance)
    out.wanted.emplace_back("board farther away");
}

}  // namespace

PoseCoverage pose_coverage(const std::vector<BoardPair>& pairs, const std::vector<RoughPose>& poses,
                           cv::Size picture) {
  constexpr std::size_t kPairs = 12;
  PoseCoverage out;
  for (std::size_t view = 0; view < 2; ++view) {
    std::vector<const BoardCorners*> boards;
    for (const BoardPair& pair : pairs) boards.push_back(&pair.corners[view]);
    out.pictures[view] = coverage_of(boards, picture);
  }
  want_places(out, 0);
  want_tilts(out, poses);
  want_distances(out, poses);
  want_places(out, 1);
  if (out.wanted.empty() && pairs.size() < kPairs)
    out.wanted.push_back(fmt::format("new poses of the board, {} more", kPairs - pairs.size()));
  return out;
}

}  // namespace hypotrack::calibrate
