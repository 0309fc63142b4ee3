#pragma once

#include <array>
#include <string_view>

#include "base/exported.hpp"
#include "hypotrack/api/solution.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// What the tracker knows of a model and does about it. It knows a model once it has learned its
/// looks in a frame in which the pose was surely right.
enum class Phase {
  awaited,    ///< expected at the given start, but not seen there
  begun,      ///< followed from the given start, not known yet
  sought,     ///< looked for in the pictures without knowing its looks
  tentative,  ///< followed from where the pictures may show it, not known yet
  followed,   ///< known, likely right
  doubted,    ///< known, perhaps right
  lost,       ///< known, looked for in the pictures
  absent,     ///< known, looked for, and not in the pictures
};
inline constexpr std::array<std::string_view, 8> kPhaseNames{
    "awaited", "begun", "sought", "tentative", "followed", "doubted", "lost", "absent"};

/// What changes a model's phase. The first four are the judgement of a frame.
enum class PhaseEvent {
  found,      ///< the pose is likely right
  plausible,  ///< the pose is perhaps right
  denied,     ///< there is no pose, or none that is likely
  departed,   ///< the model is not in the pictures
  learned,    ///< the tracker knows its looks
  forgotten,  ///< the given start, or what was learned, is contradicted and dropped
  restarted,  ///< the user asks for a search anew
};
inline constexpr std::array<std::string_view, 7> kPhaseEventNames{
    "found", "plausible", "denied", "departed", "learned", "forgotten", "restarted"};

/// Returns the phase after an event: the tracker's only table of transitions.
Phase next(Phase phase, PhaseEvent event);

/// Returns the event that a model's status in a frame is. Throws for `missing`: nothing was judged.
PhaseEvent event_of(Status judgement);

/// Returns whether the tracker goes on from a pose of the model.
constexpr bool has_pose(Phase phase) {
  using enum Phase;
  return phase == begun || phase == tentative || phase == followed || phase == doubted;
}

/// Returns whether the model is expected at the given start until it is known.
constexpr bool is_at_start(Phase phase) { return phase == Phase::awaited || phase == Phase::begun; }

/// Returns whether nothing tells where the model is: neither a start nor a frame that was sure.
constexpr bool is_unknown(Phase phase) {
  return phase == Phase::sought || phase == Phase::tentative;
}

}  // namespace internal
}  // namespace hypotrack
