#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/plugin/optimizer.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Differences between the residuals of neighbouring points and those of one point, stored only
/// where they differ. Most residuals do not depend on most parameters.
class DifferenceBlocks {
 public:
  /// Begins `columns` empty columns beside the residuals `here`, which are copied.
  void begin(std::span<const float> here, Eigen::Index columns);

  /// Stores column i: `residuals` minus those of begin(), of equal length. Different columns may be
  /// set from several threads at once.
  void set(Eigen::Index i, std::span<const float> residuals);

  /// Computes the normal equations, where column i of J is difference column i times scale[i], or 0
  /// if that is 0. Uses the threads of the calling arena; equal columns give equal results.
  NormalEquations normal_equations(const Eigen::Ref<const Eigen::VectorXd>& scale) const;

 private:
  struct Column {
    std::vector<std::uint32_t> blocks = {};  // that differ, ascending
    std::vector<float> differences = {};     // of these blocks, one after the other
  };
  class Sum;

  /// Returns the first blocks of `count` parts of about equal work, and the last part's end.
  std::vector<std::size_t> equal_parts(std::size_t count) const;

  std::vector<float> here_;  // padded with zeros to whole blocks
  std::vector<Column> columns_;
};

/// Computes the normal equations from residuals r at a point (M) and at D neighbours (MxD). Column
/// d of J is (beside.col(d) - r) * scale[d]; columns with scale 0 are ignored.
NormalEquations normal_equations(const Eigen::Ref<const Eigen::VectorXf>& r,
                                 const Eigen::Ref<const Eigen::MatrixXf>& beside,
                                 const Eigen::VectorXd& scale);

/// Returns `scale` with 0 for columns of infinite cost, whose residuals are undefined.
Eigen::VectorXd scale_of_finite(const Eigen::Ref<const Eigen::VectorXd>& scale,
                                const Eigen::Ref<const Eigen::VectorXd>& costs);

}  // namespace internal
}  // namespace hypotrack
