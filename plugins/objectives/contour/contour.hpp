#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "color_histograms.hpp"
#include "contour_views.hpp"
#include "hypotrack/plugin/linearization.hpp"
#include "hypotrack/plugin/objective.hpp"
#include "hypotrack/plugin/plugin_object.hpp"
#include "params.hpp"
#include "region_fit.hpp"
#include "terms.hpp"

namespace hypotrack::contour {

/// Pulls the outlines of rigid models to where the colours of the picture change. Each view counts
/// by itself, so that one camera is enough. prepare() first fits the models to the frame
/// (fit_region()), which gives refined_start(). Lines of one-pixel segments across the outlines of
/// that pose then make the residuals. The cost is the
///
///   mean over views, sum over models and lines, of (d / sigma)^2 / (1 + (d / reach)^2),
///
/// with d the distance in pixels of the outline's point from the line's mean (terms.hpp). With
/// `depth_sigma_mm`, points of the surface are pulled to the planes of measured ones.
///
/// Colours are learned along the outlines of the start, and then of every answer. Models with
/// joints cost nothing. Lines of a model that another one hides are left out.
class Contour : public Objective, public ResidualTerm, public CameraTurnTerm {
 public:
  using Params = contour::Params;

  /// Draws models that are not in the cache.
  Contour(const Params& params, const Scene& scene, const PluginLog& log = {});

  std::optional<CameraTurn> camera_turn(std::span<const double> state) const override {
    return contour::camera_turn(lines_, state);
  }

 protected:
  bool do_needs_rendering() const override { return false; }
  ImageUse do_image_use() const override {
    return {.mask = false, .depth = params_.depth_sigma > 0};
  }
  /// Uses the views with colour. Throws DataError if none has, and with `depth_sigma_mm` if none
  /// has depth.
  void do_prepare(const Observation& observation) override;
  double do_cost(const RenderedHypothesis& hypothesis) const override;

  const ResidualTerm* do_residual_term() const override { return this; }
  std::int64_t do_residual_count() const override {
    return contour::residual_count(lines_) + contour::residual_count(depths_);
  }
  void do_write_residuals(const RenderedHypothesis& hypothesis,
                          std::span<float> residuals) const override;
  double do_cost_and_residuals(const RenderedHypothesis& hypothesis,
                               std::span<float> residuals) const override;
  bool do_has_jacobian() const override { return true; }
  void do_write_jacobian(const RenderedHypothesis& hypothesis, std::span<float> residuals,
                         Jacobian& jacobian) const override;

  Eigen::VectorXd do_refined_start() const override { return refined_; }

 private:
  struct RigidModel {
    int offset;  ///< in the state
    ContourViews contours;
    std::vector<SurfacePoint> surface;         ///< for depth
    std::vector<ColorHistograms> colors = {};  ///< one per view
  };
  /// A frame whose answer is not known yet.
  struct SeenFrame {
    int frame;
    std::vector<TileView> views;
  };

  /// A view with colour, for all models.
  struct Picture {
    const TileView* view;
    std::size_t index;  ///< of the view
    cv::Mat4b color;    ///< as in RegionPixels
    cv::Mat1f nearest;  ///< see RegionView
  };

  void learn(const Observation& observation);
  /// Learns from the outlines of a state. Nothing is learned of a model that is hardly in the tile.
  void learn_from(const Eigen::VectorXd& state, const std::vector<TileView>& views, double weight);
  std::vector<Picture> pictures_of(const Observation& observation) const;
  /// Returns the distances of the models next to the camera; empty if there is one model only.
  cv::Mat1f nearest(const Eigen::VectorXd& state, const TileCamera& camera) const;
  /// Fits a model to the views and adds its lines.
  void fit(const RigidModel& model, const Observation& observation,
           const std::vector<Picture>& pictures);

  Params params_;
  std::vector<RigidModel> models_;
  std::optional<SeenFrame> last_;
  int learned_ = -1;        ///< the last frame that was learned from
  bool from_guess_ = true;  ///< nothing but guesses was learned from
  std::vector<LineSet> lines_;
  std::vector<DepthSet> depths_;
  Eigen::VectorXd refined_;
};

}  // namespace hypotrack::contour
