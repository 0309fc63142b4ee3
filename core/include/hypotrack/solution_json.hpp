#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "hypotrack/export.hpp"
#include "hypotrack/scene.hpp"
#include "hypotrack/solution.hpp"

namespace hypotrack {

/// Writes a solution as one line of JSON, without the line's end: frame, time, status, cost and by
/// model its status, probability, parameters and landmarks.
///
///   {"frame":0,"time":0.0,"status":"tracked","cost":0.2,"models":{"box":{"status":"tracked",
///    "probability":0.9,"parameters":{"position_x":0.1,...},"landmarks":{"lid":[x,y,z],...}}}}
///
/// Metres, radians, world axes. Numbers read back bit for bit. NaN and infinity are null, and so
/// are a status and a probability that the solution lacks. Bytes that are not UTF-8 are replaced.
/// A `stamp` (Frame::stamp, nanoseconds) is written after the time, as stamp_text() does
/// (hypotrack/tables.hpp).
HYPOTRACK_API std::string solution_json(const Scene& scene, const Solution& solution,
                                        std::optional<std::int64_t> stamp = {});

}  // namespace hypotrack
