#pragma once

#include <Eigen/Core>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hypotrack/api/export.hpp"
#include "hypotrack/plugin/observation.hpp"
#include "hypotrack/plugin/plugin_object.hpp"

namespace hypotrack {

namespace cuda {
class DeviceObjective;
}
class Objective;
struct TermTimes;

/// The depth of one hypothesis in one view's tile.
struct DepthTile {
  int width = 0;
  int height = 0;
  int stride = 0;                        ///< floats per row, >= width; rows may be read up to it
  const float* inverse_depth = nullptr;  ///< 1/z in 1/m of the nearest surface; 0 = not covered
  /// Box that may be covered: x0 <= x < x1, y0 <= y < y1. Outside it the depth is 0.
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

/// One posed and drawn hypothesis.
struct RenderedHypothesis {
  std::span<const double> state;     ///< normalised, Scene::dimension() numbers
  std::span<const DepthTile> views;  ///< one per view; empty if no objective needs rendering
};

/// Derivatives of residuals with respect to a scene's normalised state: one row per residual, one
/// column per number of the state, in the order of Scene::parameters(). Stored row after row.
using Jacobian = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// The residuals of an objective, for least-squares optimizers. Least squares with analytic
/// Jacobians takes write_jacobian() where a term has it, otherwise write_slopes(), otherwise
/// differences of residuals. Terms of all three kinds can be in one scene.
///
/// Functions that write throw PluginError, naming the objective, if a number is not finite.
class HYPOTRACK_API ResidualTerm {
 public:
  ResidualTerm() = default;
  virtual ~ResidualTerm();
  ResidualTerm(const ResidualTerm&) = delete;
  ResidualTerm& operator=(const ResidualTerm&) = delete;

  /// Returns the number of residuals per hypothesis of the prepared frame; may be 0. Throws
  /// PluginError if it is negative, or more than memory can hold.
  std::int64_t residual_count() const;

  /// Writes the residuals of a hypothesis, `residual_count()` finite numbers. Each entry belongs to
  /// the same pixel (joint, pair of spheres) for every hypothesis, so that residuals of two
  /// hypotheses can be subtracted.
  /// The sum of squares should be the cost plus a constant of the frame. If the cost is not a sum
  /// of squares, this sum must rise and fall with the cost, by about as much. Called from several
  /// threads at once; equal inputs give equal results.
  void write_residuals(const RenderedHypothesis& hypothesis, std::span<float> residuals) const;

  /// Returns true if every residual belongs to a pixel, so that pixel_views() and write_slopes()
  /// work. The answer never changes.
  bool has_slopes() const { return do_has_slopes(); }

  /// Returns the views whose pixels the residuals belong to, in the order of the residuals. Each
  /// view has one residual per pixel of its tile, rows without gaps. Requires has_slopes() and a
  /// prepared frame.
  std::span<const int> pixel_views() const;

  /// Writes the residuals of view pixel_views()[i] and their slopes d r / d(1/z), in metres, with
  /// respect to the surface drawn at the pixel. The slope is 0 where nothing is drawn.
  /// The optimizer adds how surfaces and silhouettes move to get a Jacobian. Take differences over
  /// half a pixel of the image, not derivatives at a point, because pixels are noisy. Called from
  /// several threads at once.
  void write_slopes(const RenderedHypothesis& hypothesis, std::size_t i, std::span<float> residuals,
                    std::span<float> slopes) const;

  /// Returns true if write_jacobian() works. The answer never changes.
  bool has_jacobian() const { return do_has_jacobian(); }

  /// Writes the residuals of a hypothesis and their derivatives, d residuals[i] / d state[k] at
  /// (i, k). `jacobian` comes in its final size and filled with zeros; another size afterwards is a
  /// PluginError.
  /// Along a unit quaternion, only derivatives within the unit sphere matter: whether the residual
  /// normalises it does not. Where a residual has a kink, any slope between those of its sides
  /// will do. Called from several threads at once.
  void write_jacobian(const RenderedHypothesis& hypothesis, std::span<float> residuals,
                      Jacobian& jacobian) const;

 protected:
  // What plugins write: each function as the public one of its name says.
  virtual std::int64_t do_residual_count() const = 0;
  virtual void do_write_residuals(const RenderedHypothesis& hypothesis,
                                  std::span<float> residuals) const = 0;
  virtual bool do_has_slopes() const { return false; }
  virtual std::span<const int> do_pixel_views() const;
  virtual void do_write_slopes(const RenderedHypothesis& hypothesis, std::size_t i,
                               std::span<float> residuals, std::span<float> slopes) const;
  virtual bool do_has_jacobian() const { return false; }
  virtual void do_write_jacobian(const RenderedHypothesis& hypothesis, std::span<float> residuals,
                                 Jacobian& jacobian) const;

 private:
  friend class Objective;
  mutable std::atomic<const Objective*> owner_ = nullptr;  ///< once residual_term() was called
};

/// A number for every pixel of one view's tile, for pictures that explain a cost.
struct PixelMap {
  std::string name;  ///< a few words: `distinctiveness`
  int view = 0;
  cv::Mat values;     ///< 32-bit float of the tile's size; NaN where there is none
  float lowest = 0;   ///< shown as the darkest colour
  float highest = 1;  ///< shown as the brightest colour
};

/// The images that an objective reads.
struct ImageUse {
  bool color = true;
  bool mask = true;
  bool depth = true;
  bool background = false;  ///< TileView::background, which the tracker learns
  bool previous = false;    ///< PreviousSolution::views, colour only
};

/// A term of the cost: how badly a hypothesis explains a frame. A scene adds weighted terms.
class HYPOTRACK_API Objective : public PluginObject {
 public:
  Objective();
  ~Objective() override;

  /// Returns false for a term that needs no rendering. One that reads pictures even so overrides
  /// do_image_use(); others are taken for terms of the state alone (joint limits, priors).
  bool needs_rendering() const { return do_needs_rendering(); }

  /// Returns the images that `prepare` reads. An image that no objective of the scene reads may be
  /// missing from the observation: it is then neither resampled nor uploaded to a GPU.
  ImageUse image_use() const { return do_image_use(); }

  /// Prepares features of a frame that make scoring fast. The observation outlives every `cost`
  /// until the next `prepare`. Throws DataError if the observation does not suit (one view for a
  /// stereo objective). Several objectives are prepared at the same time.
  void prepare(const Observation& observation);

  /// Returns the cost of a hypothesis: lower is better, +infinity is infeasible. Called from
  /// several threads at once; equal inputs give equal results. Throws PluginError, naming the
  /// objective, if the cost is NaN or -infinity, as costs() and cost_and_residuals() do.
  double cost(const RenderedHypothesis& hypothesis) const;

  /// Returns the most hypotheses of one call of costs(). 0: it scores one at a time. Otherwise the
  /// scene is evaluated on the CPU, which draws a block before each call. The answer never changes.
  int most_at_once() const { return do_most_at_once(); }

  /// Computes the costs of many drawn hypotheses, as cost() does. Called from one thread at a time.
  void costs(std::span<const RenderedHypothesis> hypotheses, std::span<double> costs) const;

  /// Returns the objective's residuals, or null if it has none. The answer never changes.
  /// The objective owns the result (it may derive from ResidualTerm and return itself).
  const ResidualTerm* residual_term() const;

  /// Returns the value of cost() (up to rounding) and writes the residuals of residual_term().
  /// Requires a residual_term(). Override do_cost_and_residuals() if one pass over the pixels gives
  /// both. Throws PluginError if a residual is not finite although the cost is.
  double cost_and_residuals(const RenderedHypothesis& hypothesis, std::span<float> residuals) const;

  /// Returns the state from which to search the prepared frame first, in place of
  /// Observation::start. Only the models that the objective knows differ from it. Empty: no better
  /// one is known. Throws PluginError on another size or numbers that are not finite.
  Eigen::VectorXd refined_start() const;

  /// Returns true if maps() gives some. `prepare` may then be called again with the same frame, and
  /// must not learn from it.
  bool has_maps() const { return do_has_maps(); }

  /// Returns what cost() reads and finds at every pixel, for a hypothesis of the prepared frame.
  std::vector<PixelMap> maps(const RenderedHypothesis& hypothesis) const;

  /// Returns the GPU implementation (hypotrack/gpu/device_objective.hpp), or null without one or
  /// without CUDA. With null, a term that needs rendering keeps the whole scene on the CPU;
  /// another is evaluated there beside the GPU. The objective outlives the result.
  std::unique_ptr<cuda::DeviceObjective> on_device() const;

  /// Returns how long the objective has worked so far; grows.
  std::shared_ptr<const TermTimes> times() const;

 protected:
  // What plugins write: each function as the public one of its name says.
  virtual bool do_needs_rendering() const { return true; }
  virtual ImageUse do_image_use() const { return {}; }
  virtual void do_prepare(const Observation& observation) = 0;
  virtual double do_cost(const RenderedHypothesis& hypothesis) const = 0;
  virtual int do_most_at_once() const { return 0; }
  virtual void do_costs(std::span<const RenderedHypothesis> hypotheses,
                        std::span<double> costs) const;
  virtual const ResidualTerm* do_residual_term() const { return nullptr; }
  virtual double do_cost_and_residuals(const RenderedHypothesis& hypothesis,
                                       std::span<float> residuals) const;
  virtual Eigen::VectorXd do_refined_start() const { return {}; }
  virtual bool do_has_maps() const { return false; }
  virtual std::vector<PixelMap> do_maps(const RenderedHypothesis& hypothesis) const;
  virtual std::unique_ptr<cuda::DeviceObjective> do_on_device() const;

 private:
  friend class ResidualTerm;
  std::shared_ptr<TermTimes> times_;
  Eigen::Index dimension_ = 0;  ///< of the prepared frame's state
};

}  // namespace hypotrack

/// Checks of an observation for objectives. All throw DataError, which names `objective`, what was
/// found and what was expected.
namespace hypotrack {

/// Throws unless an image has its tile's size and the OpenCV type. `what` names it in the message:
/// "colour image", ...
HYPOTRACK_API void check_tile_image(std::string_view objective, const cv::Mat& image, int type,
                                    const TileView& view, std::size_t index, const char* what);

/// Throws unless the first two views have colour images of their tile's size, at least 2x2 pixels.
HYPOTRACK_API void check_color_pair(std::string_view objective, const Observation& observation);

/// Throws unless both of the first two views have colour on the device. `has_color` says which of
/// them have it.
HYPOTRACK_API void check_color_pair(std::string_view objective, const Observation& header,
                                    const bool (&has_color)[2]);

/// Throws unless the hypothesis has a drawn view `index` of this size.
HYPOTRACK_API void check_drawn_tile(std::string_view objective,
                                    const RenderedHypothesis& hypothesis, std::size_t index,
                                    int width, int height);

}  // namespace hypotrack
