#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "energy.hpp"
#include "finger_pair.hpp"
#include "foreground.hpp"
#include "hypotrack/plugin/objective.hpp"
#include "params.hpp"
#include "score.hpp"

namespace hypotrack::rgbd_depth {

/// Compares a hypothesis with a depth image and its foreground:
///   [1] I. Oikonomidis, N. Kyriazis, A. A. Argyros, "Efficient model-based 3D tracking of hand
///       articulations using Kinect", BMVC 2011: the objective E, for one hand;
///   [2] the same authors, "Tracking the articulated motion of two strongly interacting hands",
///       CVPR 2012: E over both hands, drawn together, with the fingers of both in kc.
///
///   E = D + lambda S + lambda_k kc                                             = the cost
///   D = sum min(|o_d - r_d|, d_M) / (sum (o_s or r_m) + eps)                   in cm
///   S = 1 - 2 sum (o_s and r_m) / (sum (o_s and r_m) + sum (o_s or r_m))
///   kc = sum -min(phi, 0) over adjacent fingers, the thumb excluded, phi the difference of their
///        abductions in radians
///
/// o_s is the observed foreground. o_d is its observed depth; background has none, whatever the
/// sensor measured there, as in [1], where the depth map is set to zero outside the foreground. r_d
/// is the rendered depth. r_m are rendered pixels where the depths differ by d_m or less, or where
/// o_d is missing. eps = 1e-6. So a pixel adds
///
///   observed                  hypothesis            to D         o_s and r_m   o_s or r_m
///   foreground with depth     covers it           min(|.|, d_M)  if |.| <= d_m     1
///   foreground with depth     does not              d_M              0             1
///   foreground, no depth      covers it             0                1             1
///   foreground, no depth      does not              0                0             1
///   background                covers it             d_M              0             1
///   background                does not              0                0             0
///   outside of the image      either                0                0             0
///
/// Differences from the papers:
/// - A hole of the sensor within the foreground adds nothing to D. |0 - r_d| would add d_M to a
///   correct hypothesis.
/// - The sums run over all views with depth together, so that the scale of the cost does not depend
///   on their number.
/// - Foreground by depth lies within range_mm in front of and behind the last solution's surfaces,
/// in
///   the tile around it ([1]: within 25 cm of the hand's last position). Foreground by skin colour
/// is
///   Chai and Ngan's chrominance box (foreground-inl.hpp), where [1] learns its colours.
/// - S is 1, its worst value, where nothing was observed and nothing is drawn.
///
/// E is no sum of squares. Its residuals approximate it near the observation. P is what a pixel
/// adds to E (pixel_penalties.hpp). A covered pixel has sqrt(P) (r_d - o_d) / d_M, clamped to
/// +-sqrt(P). A pixel in only one of hypothesis and foreground has sqrt(P). A pair of fingers has
/// sqrt(lambda_k / 0.1) max(-phi, 0), whose square is E's term where fingers cross by 0.1 radians.
class RgbdDepth : public Objective, public ResidualTerm {
 public:
  using Params = rgbd_depth::Params;

  explicit RgbdDepth(const Params& params);

 private:
  ImageUse do_image_use() const override;
  /// Uses the views that have depth. Throws DataError if none has, if a view lacks the mask or
  /// colour that the parameters need, and on images without their tile's size and type.
  void do_prepare(const Observation& observation) override;
  /// Throws DataError if the drawn tiles are not those of the prepared frame.
  double do_cost(const RenderedHypothesis& hypothesis) const override;
  std::unique_ptr<cuda::DeviceObjective> do_on_device() const override;

  const ResidualTerm* do_residual_term() const override { return this; }
  std::int64_t do_residual_count() const override;
  /// Throws DataError as cost() does.
  void do_write_residuals(const RenderedHypothesis& hypothesis,
                          std::span<float> residuals) const override;

  struct PreparedView {
    std::size_t index;  ///< among the observation's views
    ObservedView observed;
    PixelPlane<float> uncovered;  ///< residuals of uncovered pixels
  };

  void price_pixels();
  Weights weights() const;
  void check_tiles(const RenderedHypothesis& hypothesis) const;

  Params params_;
  std::vector<PreparedView> views_;
  PixelPenalties penalties_;
  std::vector<FingerPair> fingers_;
};

}  // namespace hypotrack::rgbd_depth
