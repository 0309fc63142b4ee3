#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>

#include "hypotrack/error.hpp"
#include "hypotrack/pose.hpp"
#include "hypotrack/start.hpp"
#include "session/opened_scene.hpp"
#include "track/displace.hpp"

namespace hypotrack {

Start::~Start() = default;

std::optional<Eigen::VectorXd> start_state(const OpenedScene& session, const Frame* frame) {
  const Scene& scene = *session.scene;
  // A tracker may have taken the parts already.
  const std::vector<Camera>& cameras =
      session.source ? session.source->cameras() : session.parts.cameras;
  std::optional<Eigen::VectorXd> state = session.start->state({scene, cameras, frame});
  const InitSettings& init = session.init;
  const std::string who = fmt::format(
      "the start '{}'", init.from.is_map() ? init.from.get("type").scalar() : init.from.scalar());
  if (!state && frame)
    throw ConfigError(fmt::format("{} gives no state for frame {}; this is a bug in the start", who,
                                  frame->index));
  if (!state) return state;
  scene.check(*state, who);
  if (init.pose.defined()) state = read_pose(init.pose, scene, *std::move(state));
  if (init.away == 0 && init.away_turn == 0 && init.away_angles == 0) return state;
  return displaced(scene, *std::move(state), {init.away, init.away_turn, init.away_angles},
                   session.seed);
}

Eigen::VectorXd initial_state(const OpenedScene& session, const Frame& first) {
  return *start_state(session, &first);
}

}  // namespace hypotrack
