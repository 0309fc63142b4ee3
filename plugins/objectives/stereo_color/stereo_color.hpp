#pragma once

#include <array>
#include <memory>
#include <vector>

#include "features.hpp"
#include "hypotrack/plugin/objective.hpp"
#include "params.hpp"
#include "residuals.hpp"
#include "score.hpp"

namespace hypotrack::stereo_color {

/// Colour consistency of a hypothesis in a stereo pair: Panteleris and Argyros, "Back to RGB: 3D
/// tracking of hands and hand-object interactions based on short-baseline stereo", ICCV workshops
/// 2017. The equations below are the paper's, in its order and symbols (l for lambda).
///
/// Distinctiveness, once per frame and view (the paper's measure after Harris and Stephens). With
/// l1 >= l2 the eigenvalues of the auto-correlation matrix of the grey image's gradients, summed
/// over 3x3 pixels:
///   d = log sqrt(l1^2 + l2^2)            strength of the texture
///   a = atan2(l2, l1), 0 .. pi/4         cornerness: 0 along an edge
///   d_s = 1 / (1 + exp(m_d - d)), a_s = 1 / (1 + exp(m_a - a)), m the medians over the tile
///   C = d_s a_s, or 0 where that is below w_t
/// Score of a hypothesis, over the pixels of the left view that it covers and whose surface point
/// the right view sees too (within r of the depth rendered there):
///   s = min(C_l, C_r) exp(-beta ||I_l - I_r||),   S = sum of s,   cost = -S
///
/// Choices where the paper leaves room: the natural logarithm, of the norm + 1e-12 (flat areas);
/// colours in 0..1 with the Euclidean norm; medians over all pixels of the tile inside the image,
/// background included; gradients by central differences (their scale cancels with the medians);
/// the right view read at the nearest pixel. Extensions: the other values of color_space,
/// aggregation, direction, lookup, distinctiveness and falloff; a beta that follows the noise of
/// the pictures (beta_of()); a coverage penalty:
///   s = min(C_l, C_r) (exp(-x) - coverage_penalty),   x = beta ||I_l - I_r||, or its square
///   (gaussian)
/// so that covering pixels less alike than the coverage penalty, mostly background, costs; a
/// gray_weight g:
///   ||I_l - I_r||^2 = |d|^2 - (1 - g^2) (d_R + d_G + d_B)^2 / 3,   d = I_l - I_r
/// because highlights have the light's colour and lie elsewhere for each camera (Shafer, "Using
/// color to separate reflection components", Color Research and Application 1985).
///
/// A hypothesis without a pixel that both views see costs 0, without a coverage penalty the worst
/// cost.
///
/// With the aggregation `sum` the cost is a sum of squares, up to a constant of the frame. Every
/// pixel of the left tile, covered or not, has the residual sqrt(C - s). s is 0 unless both views
/// see its surface, and negative where the coverage penalty exceeds the similarity. So a silhouette
/// that misses a distinctive pixel has a residual at that pixel. With `both` directions each pixel
/// of either tile has the residual sqrt((C - s) / 2).
class StereoColor : public Objective, public ResidualTerm {
 public:
  using Params = stereo_color::Params;

  explicit StereoColor(const Params& params);

 private:
  ImageUse do_image_use() const override;
  /// Uses the first two views. Throws DataError if there are fewer, on tiles under 2x2 pixels, and
  /// on images without their tile's size and type.
  void do_prepare(const Observation& observation) override;
  /// Throws DataError if the drawn tiles are not those of the prepared frame.
  double do_cost(const RenderedHypothesis& hypothesis) const override;
  std::unique_ptr<cuda::DeviceObjective> do_on_device() const override;
  bool do_has_maps() const override { return true; }
  /// Returns distinctiveness C, colour difference and consistency s. Throws DataError as cost()
  /// does.
  std::vector<PixelMap> do_maps(const RenderedHypothesis& hypothesis) const override;

  /// Returns this, or null if the aggregation divides the sum.
  const ResidualTerm* do_residual_term() const override;
  std::int64_t do_residual_count() const override;
  /// Throws DataError as cost() does.
  void do_write_residuals(const RenderedHypothesis& hypothesis,
                          std::span<float> residuals) const override;
  bool do_has_slopes() const override { return true; }
  std::span<const int> do_pixel_views() const override;
  /// Throws DataError as cost() does.
  void do_write_slopes(const RenderedHypothesis& hypothesis, std::size_t i,
                       std::span<float> residuals, std::span<float> slopes) const override;
  double do_cost_and_residuals(const RenderedHypothesis& hypothesis,
                               std::span<float> residuals) const override;

  void check_tiles(const RenderedHypothesis& hypothesis) const;
  double score(const Similarity& similarity) const;
  double cost_of(double scores) const;  ///< of the sum of the used directions' scores
  bool uses(std::size_t from) const;    ///< whether pixels of this view are summed
  float share() const;                  ///< weight of each used direction

  Params params_;
  Params of_frame_;  // with the frame's beta
  std::array<Features, 2> features_;
  std::array<StereoMap, 2> maps_;               // from each view into the other
  std::array<PixelPlane<float>, 2> uncovered_;  // residuals where nothing is covered
};

}  // namespace hypotrack::stereo_color
