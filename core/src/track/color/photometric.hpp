#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "hypotrack/export.hpp"
#include "hypotrack/params.hpp"
#include "tile/tiles.hpp"
#include "track/color/color_samples.hpp"
#include "track/color/highlights.hpp"

namespace hypotrack {

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

/// How the colours of each view become those of the first, learned from frame to frame.
class HYPOTRACK_API PhotometricMatch {
 public:
  /// The scene must outlive it.
  PhotometricMatch(const Scene& scene, const PhotometricSettings& settings);

  /// Before the first search: learns from the start's pose, if both views show the same there
  /// (correlation), as they do if it is no more than some 10 mm off. Where they do not, maps bring
  /// the whole pictures' colours together until a solution teaches more, and nothing counts as
  /// learned. To be called while nothing is known.
  void begin(const TileMaker& tiles, const Frame& frame, const TilePlan& plan,
             const Eigen::VectorXd& start);

  /// Looks at a frame with the scene posed in a normalised state, and changes the maps. `plan` is
  /// of the frame. Where a frame teaches nothing (fit_color_map), maps stay. Does nothing with one
  /// view or with match off.
  void learn(const TileMaker& tiles, const Frame& frame, const TilePlan& plan,
             const Eigen::VectorXd& state);

  void forget() { views_.clear(); }
  /// The map of a view's colours to the first's (view from 1 on); identity where nothing is known.
  ColorMap colors(std::size_t view) const {
    return view <= views_.size() ? views_[view - 1].map : ColorMap{};
  }
  /// Whether anything has been learned.
  bool knows() const;
  /// Puts the maps, and by how much the first two views still differ, into the plan of a frame.
  void apply(TilePlan& plan) const;
  /// Puts what highlights are expected to make the other views differ by, if the scene is about as
  /// in a normalised state, into the plan as well; nothing if the settings do not ask for that.
  void apply_highlights(TilePlan& plan, const Eigen::VectorXd& state);

 private:
  /// One view's map and the number of frames that it was learned from.
  struct Learned {
    ColorMap map;
    double difference = 0;  ///< Observation::color_difference
    int frames = 0;
    Highlights highlights;
  };
  void learn(Learned& learned, const ColorSamples& samples, std::size_t view) const;
  /// Colours without the highlights known so far, then highlights without these colours.
  void learn_both(Learned& learned, const ColorSamples& samples, const ViewDirections& to) const;
  void update(Learned& learned, const ColorMap& found, double difference) const;

  PhotometricSettings settings_;
  ColorSampler sampler_;
  std::vector<Learned> views_;  // but for the first
};

}  // namespace hypotrack
