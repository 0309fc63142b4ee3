#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hypotrack/api/export.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/api/scene.hpp"

namespace hypotrack {

/// Status that a tracker gives a frame, or one model in it.
enum class Status {
  tracked,    ///< likely right, judged by the pictures or, where they do not tell, by the cost
  uncertain,  ///< perhaps right, sigma is large, or part of the scene is out of view
  lost,    ///< improbable, out of view, infeasible, an outlier for too long, off the foreground, or
           ///< sigma is above `lost_sigma`
  absent,  ///< a search of the whole pictures did not find it
  missing,  ///< no usable frame; the state is the last one
};
HYPOTRACK_API std::string_view to_string(Status status);

/// The result of one frame.
struct Solution {
  int frame = 0;
  double time = 0;
  Status status = Status::missing;  ///< the worst of the models'; absent only if all are
  std::vector<Status> models;       ///< by model
  double cost = 0;                  ///< NaN if the frame was missing
  std::int64_t evaluations = 0;
  double seconds = 0;     ///< wall time from the frame to the result: tiles, features and search
  Eigen::VectorXd state;  ///< parameters of the scene, quaternions normalised; smoothed if the
                          ///< scene has `output.smoothing`
  /// Landmarks of the scene in that state: 3xL, world, metres; named by Scene::landmark_names().
  Eigen::Matrix3Xd landmarks;
  /// Root mean square error expected of each landmark, in metres. Empty if uncertainty is off, NaN
  /// if the frame was missing.
  Eigen::VectorXd sigma;
  /// Flags landmarks that something before the models hides in both views, by Scene::landmarks():
  /// their positions are guesses. Empty if it hides none.
  std::vector<bool> hidden = {};
  /// Probability, by model, that its pose is right, judged by the pictures; NaN: unknown.
  std::vector<double> probabilities = {};
  FrameFault fault = FrameFault::none;  ///< what is wrong with the frame's pictures or time
  int fault_view = 0;                   ///< number of the view that has the fault
};

/// Writes a solution as one line of JSON, without the line's end: frame, time, status, cost and by
/// model its status, probability, parameters and landmarks.
///
///   {"frame":0,"time":0.0,"status":"tracked","cost":0.2,"models":{"box":{"status":"tracked",
///    "probability":0.9,"parameters":{"position_x":0.1,...},"landmarks":{"lid":[x,y,z],...}}}}
///
/// Metres, radians, world axes. Numbers read back bit for bit. NaN and infinity are null, and so
/// are a status and a probability that the solution lacks. Bytes that are not UTF-8 are replaced.
/// A `stamp` (Frame::stamp, nanoseconds) is written after the time, as stamp_text() does
/// (hypotrack/api/tables.hpp).
HYPOTRACK_API std::string solution_json(const Scene& scene, const Solution& solution,
                                        std::optional<std::int64_t> stamp = {});

}  // namespace hypotrack
