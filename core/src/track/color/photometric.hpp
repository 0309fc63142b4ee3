#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/plugin/params.hpp"
#include "tile/tiles.hpp"
#include "track/color/color_samples.hpp"
#include "track/color/highlights.hpp"
#include "track/side_work.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// `photometric:` of a scene.
struct PhotometricSettings {
  bool match = true;
  double rate = 0.3;
  double max_change = 4;
  bool highlights = false;
  void visit(ParamVisitor& v) {
    v("match", match,
      {.help = "bring the other views' colours to the first's before they are compared: gain and "
               "offset per channel, learned where both see the last solution"});
    v("rate", rate,
      {.help = "share of a frame's estimate in the next map", .min = 0.001, .max = 1});
    v("max_change", max_change,
      {.help = "most that a map changes per frame, in dark and in bright places",
       .min = 0.01,
       .max = 255,
       .unit = "of 255"});
    v("highlights", highlights,
      {.help =
           "with `match`, also take off what highlights make the other views differ by, learned "
           "by the surface's normals; tiles are then cut on the CPU"});
  }
};

/// Learns from frame to frame how to map each view's colours to the first's.
class PhotometricMatch {
 public:
  /// The scene must outlive the object.
  PhotometricMatch(const Scene& scene, const PhotometricSettings& settings);

  /// Initialises the maps before the first search, while nothing is learned. Learns from the
  /// start's pose if both views show the same there (correlation), as for starts within about 10
  /// mm. Otherwise it matches the colours of the whole pictures, and knows() stays false.
  void begin(const TileMaker& tiles, const Frame& frame, const TilePlan& plan,
             const Eigen::VectorXd& start);

  /// Updates the maps from a frame with the scene posed in a normalised state. `plan` must be of
  /// that frame. Maps stay as they are where a frame teaches nothing (fit_color_map()). Does
  /// nothing with one view or with match off. It works beside what the caller does next, without
  /// the frame; errors are thrown where the maps are used.
  void learn(const TileMaker& tiles, const Frame& frame, const TilePlan& plan,
             const Eigen::VectorXd& state);

  /// Takes by how much each view became brighter since the last frame, so that the maps need not
  /// learn it.
  void follow(std::span<const float> gains);

  void forget() { views().clear(); }
  /// Returns the map of a view's colours to the first's (view from 1 on); identity if unknown.
  ColorMap colors(std::size_t view) const {
    return view <= views().size() ? views()[view - 1].map : ColorMap{};
  }
  /// Returns whether anything was learned from a pose.
  bool knows() const;
  /// Puts the maps and the remaining difference of the first two views into the plan of a frame.
  void apply(TilePlan& plan) const;
  /// Puts the expected brightness differences by highlights into the plan, for the scene in a
  /// normalised state. Does nothing unless the settings ask for it.
  void apply_highlights(TilePlan& plan, const Eigen::VectorXd& state);

 private:
  /// One view's map and the number of frames it was learned from.
  struct Learned {
    ColorMap map;
    double difference = 0;  ///< FrameContext::color_difference
    int frames = 0;
    Highlights highlights;
  };
  /// Returns what was learned.
  std::vector<Learned>& views();
  const std::vector<Learned>& views() const;
  void learn(Learned& learned, const ColorSamples& samples, std::size_t view) const;
  /// Fits colours without the known highlights, then highlights with these colours.
  void learn_both(Learned& learned, const ColorSamples& samples, const ViewDirections& to) const;
  void update(Learned& learned, const ColorMap& found, double difference) const;

  PhotometricSettings settings_;
  ColorSampler sampler_;
  std::vector<Learned> views_;                  // without the first; see views()
  mutable SideWork learning_{"match colours"};  ///< uses all of this
};

}  // namespace internal
}  // namespace hypotrack
