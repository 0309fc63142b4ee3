#pragma once

#include <array>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/config.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/params.hpp"

namespace hypotrack::synthetic {

enum class FaultKind {
  absent,      ///< models are not in the pictures
  exchanged,   ///< each camera's picture arrives as the other's
  black,       ///< all pictures are black, without foreground and depth
  frozen,      ///< the previous picture is repeated
  missing,     ///< the frame does not arrive
  late,        ///< pictures are those of an earlier frame
  misaligned,  ///< pictures are shifted, rolled or scaled against the calibration
  exposure,    ///< pictures change their brightness step by step, and keep it
};
inline std::span<const std::string_view> enum_names(FaultKind) {
  static constexpr std::array<std::string_view, 8> kNames = {
      "absent", "exchanged", "black", "frozen", "missing", "late", "misaligned", "exposure"};
  return kNames;
}

/// An item of `faults:`.
struct FaultParams {
  Eigen::Vector2d frames{0, 0};
  FaultKind kind = FaultKind::absent;
  std::string model;
  std::optional<int> view;
  std::optional<double> noise_sigma;
  std::optional<int> by;
  Eigen::Vector2d shift{0, 0};
  std::optional<double> roll;
  std::optional<double> scale;
  std::optional<double> gain;
  void visit(ParamVisitor& v) {
    v("frames", frames,
      {.help = "first and last frame of it", .min = 0, .max = 1e7, .required = true});
    v("kind", kind, {.help = "the fault", .required = true});
    v("model", model, {.help = "of the kind absent: which one; all without it"});
    v("view", view,
      {.help = "of the kinds frozen, late, misaligned and exposure: which one; all without it",
       .min = 0,
       .max = 1});
    v("noise_sigma", noise_sigma,
      {.help = "of the kind frozen: fresh noise on the repeated picture",
       .min = 0,
       .max = 40,
       .unit = "of 255"});
    v("by", by, {.help = "of the kind late: by how many frames; default: 1", .min = 1, .max = 100});
    v("shift_px", shift,
      {.help = "of the kind misaligned: how far to the right and down",
       .min = -1000,
       .max = 1000,
       .unit = "px"});
    v("roll_deg", roll,
      {.help = "of the kind misaligned: clockwise about the principal point",
       .min = -180,
       .max = 180,
       .unit = "deg",
       .to_si = kDegree});
    v("scale", scale,
      {.help = "of the kind misaligned: factor about the principal point", .min = 0.1, .max = 10});
    v("gain", gain,
      {.help = "of the kind exposure: brightness from the last frame on, against that before",
       .min = 0,
       .max = 10});
  }
};

/// Injects faults into the pictures of chosen frames.
class Faults {
 public:
  /// `node` is the list from which `params` were read. Throws ConfigError with file:line:column on
  /// invalid intervals, on models and views that do not exist or do not apply to a kind, and on an
  /// exchange without two views of one size.
  Faults(const std::vector<FaultParams>& params, const ConfigNode& node, const Scene& scene,
         const std::vector<Camera>& cameras);

  /// Makes all models absent from frame `first` to frame `last`.
  void add_absence(int first, int last);

  /// Returns for each model of the scene whether it is absent from a frame; empty if none is.
  std::vector<bool> absent(int frame) const;

  /// Returns the first frame from `frame` on that is not missing.
  int next_delivered(int frame) const;

  /// Applies the faults to the views of a frame. Call it with all frames that are not missing, in
  /// their order.
  void apply(int frame, std::vector<View>& views);

 private:
  struct Fault {
    int first = 0, last = 0;
    FaultKind kind = FaultKind::absent;
    std::optional<std::size_t> model, view;  ///< empty: all
    double noise_sigma = 0;
    int by = 1;
    Eigen::Vector2d shift{0, 0};
    double roll = 0, scale = 1, gain = 1;
    bool concerns(std::size_t of_view) const { return view.value_or(of_view) == of_view; }
  };
  /// Returns whether a fault of a kind affects a view (or, for absent, a model) in a frame.
  bool holds(FaultKind kind, int frame, std::size_t part = 0) const;
  /// Repeats earlier pictures.
  void delay(int frame, std::vector<View>& views);
  void freeze(int frame, std::vector<View>& views);
  /// Shifts, rolls, scales and darkens pictures.
  void spoil(int frame, std::vector<View>& views) const;

  std::size_t models_;
  std::vector<Fault> faults_;
  std::vector<Eigen::Vector2d> centers_;     ///< of the views: principal points
  std::vector<View> kept_;                   ///< last pictures before the frozen ones
  std::vector<std::deque<View>> delivered_;  ///< of each view that may be late, the newest last
};

}  // namespace hypotrack::synthetic
