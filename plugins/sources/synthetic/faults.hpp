#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hypotrack/camera.hpp"
#include "hypotrack/config.hpp"
#include "hypotrack/frame.hpp"
#include "hypotrack/params.hpp"
#include "hypotrack/scene.hpp"

namespace hypotrack::synthetic {

enum class FaultKind {
  absent,     ///< models are not in the pictures
  exchanged,  ///< each camera's picture arrives as the other's
  black,      ///< all pictures are black, without foreground and depth
  frozen,     ///< the previous picture is repeated
  missing,    ///< the frame does not arrive
};
inline std::span<const std::string_view> enum_names(FaultKind) {
  static constexpr std::array<std::string_view, 5> kNames = {"absent", "exchanged", "black",
                                                             "frozen", "missing"};
  return kNames;
}

/// An item of `faults:`.
struct FaultParams {
  Eigen::Vector2d frames{0, 0};
  FaultKind kind = FaultKind::absent;
  std::string model;
  std::optional<int> view;
  void visit(ParamVisitor& v) {
    v("frames", frames,
      {.help = "first and last frame of it", .min = 0, .max = 1e7, .required = true});
    v("kind", kind, {.help = "absent, exchanged, black, frozen or missing", .required = true});
    v("model", model, {.help = "of the kind absent: which one; all without it"});
    v("view", view, {.help = "of the kind frozen: which one; all without it", .min = 0, .max = 1});
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
  };
  /// Returns whether a fault of a kind affects a view (or, for absent, a model) in a frame.
  bool holds(FaultKind kind, int frame, std::size_t part = 0) const;

  std::size_t models_;
  std::vector<Fault> faults_;
  std::vector<View> kept_;  ///< last pictures before those that are frozen
};

}  // namespace hypotrack::synthetic
