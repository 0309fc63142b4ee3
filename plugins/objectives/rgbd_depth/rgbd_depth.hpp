#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "energy.hpp"
#include "finger_crossing.hpp"
#include "foreground.hpp"
#include "hypotrack/objective.hpp"
#include "params.hpp"
#include "residuals.hpp"
#include "score.hpp"

namespace hypotrack::rgbd_depth {

/// Agreement of a hypothesis with a depth image and its foreground:
///   [1] I. Oikonomidis, N. Kyriazis, A. A. Argyros, "Efficient model-based 3D tracking of hand
///       articulations using Kinect", BMVC 2011: the objective E, for one hand;
///   [2] the same, "Tracking the articulated motion of two strongly interacting hands", CVPR 2012:
///       the same E over both hands, drawn together, with the fingers of either in kc.
///
///   E = D + lambda S + lambda_k kc                                             = the cost
///   D = sum min(|o_d - r_d|, d_M) / (sum (o_s or r_m) + eps)                   in cm
///   S = 1 - 2 sum (o_s and r_m) / (sum (o_s and r_m) + sum (o_s or r_m))
///   kc = sum -min(phi, 0) over adjacent fingers, the thumb excluded, phi the difference of their
///        abductions in radians
///
/// o_s: the observed foreground. o_d: its observed depth; background has none, whatever the sensor
/// measured there, as in [1], where the depth map is set to zero outside of the foreground. r_d:
/// the rendered depth. r_m: rendered pixels where the depths differ by d_m or less, or where o_d is
/// missing. eps = 1e-6. So a pixel adds
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
/// Where this departs from the papers:
/// - a hole of the sensor within the foreground adds nothing to D; |0 - r_d| would add d_M to a
///   hypothesis that is right;
/// - the sums run over all views with depth together, so that the scale of the cost does not depend
///   on their number;
/// - foreground by depth lies within range_mm before and behind the last solution's surfaces, in
///   the tile around it ([1]: within 25 cm of the hand's last position); by skin colour it is Chai
///   and Ngan's chrominance box (foreground-inl.hpp), where [1] learns its colours;
/// - S is 1, its worst, where nothing was observed and nothing is drawn.
///
/// E is no sum of squares. Its residuals stand in for it near the observation: per pixel
/// sqrt(P) (r_d - o_d) / d_M, cut off at +-sqrt(P), where it is covered, and sqrt(P) where one of
/// hypothesis and foreground is without the other, P being what such a pixel adds to E
/// (residuals.hpp); and per pair of fingers sqrt(lambda_k / 0.1) max(-phi, 0), whose square is
/// E's term where fingers cross by 0.1 radians.
class RgbdDepth : public Objective, public ResidualTerm {
 public:
  using Params = rgbd_depth::Params;

  explicit RgbdDepth(const Params& params);

  ImageUse image_use() const override;
  /// Uses the views that have depth. Throws DataError if none has, if a view lacks the mask or the
  /// colour that the parameters ask for, and on images that do not have their tile's size and type.
  void prepare(const Observation& observation) override;
  /// Throws DataError if the drawn tiles are not those of the prepared frame.
  double cost(const RenderedHypothesis& hypothesis) const override;
  std::unique_ptr<cuda::DeviceObjective> on_device() const override;

  const ResidualTerm* residual_term() const override { return this; }
  std::int64_t residual_count() const override;
  /// Throws DataError as cost().
  void write_residuals(const RenderedHypothesis& hypothesis,
                       std::span<float> residuals) const override;

 private:
  struct PreparedView {
    std::size_t index;  ///< among the observation's views
    ObservedView observed;
    PixelPlane<float> uncovered;  ///< residuals where nothing is covered
  };

  void price_pixels();
  Weights weights() const;
  void check_tiles(const RenderedHypothesis& hypothesis) const;

  Params params_;
  std::vector<PreparedView> views_;
  PixelPrices prices_;
  std::vector<FingerPair> fingers_;
};

}  // namespace hypotrack::rgbd_depth
