#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/exported.hpp"
#include "cost/cost.hpp"
#include "cost/cuda/frame_on_device.hpp"
#include "cost/cuda/host_batch.hpp"
#include "cost/cuda/repeated_work.hpp"
#include "cost/cuda/side_stream.hpp"
#include "hypotrack/plugin/optimizer.hpp"

namespace hypotrack::cuda {
inline namespace HYPOTRACK_EXPORTED internal {

/// States of points of linearisation in device memory, for D columns.
struct LinearizedStates {
  int points;   ///< at most DeviceLinearizer::most_together()
  int columns;  ///< D
  /// The drawn states of all points; then D + 1 of each: the drawn one, and one per column.
  BatchLayout states;
  const float* per_step;  ///< per point D: 1 / the change of the column's parameter, 0 for none
  const float* blurs;     ///< per point
  const std::int32_t* rests = nullptr;  ///< per point: PixelRowsJob::rests; null: none rests
};

/// Computes normal equations of the terms' residuals on the GPU: the HostLinearizer of the CPU,
/// there. Terms with slopes take one drawn hypothesis. The results are the same in every run.
class DeviceLinearizer {
 public:
  /// Both must outlive it; `cost` normalises states.
  DeviceLinearizer(Cost& cost, FrameOnDevice& frame) : cost_(cost), frame_(frame) {}

  /// Computes the normal equations as ResidualCost::linearize_each(), for states. Throws
  /// DeviceError if there is too little memory.
  std::vector<NormalEquations> linearize(std::span<const Neighbourhood> points);

  // For searches in device memory; the terms without slopes must be terms of the state.
  /// Returns how many of so many points can be linearised together.
  std::size_t most_together(std::size_t points);
  /// Allocates memory for such states. Throws DeviceError if there is too little.
  void reserve(std::int64_t points, int columns);
  /// Enqueues the computation of row_sums() and gram_sums(). If it throws, nothing goes on beside
  /// the stream.
  void enqueue(const LinearizedStates& at);
  /// Returns the sums of enqueue_pixel_rows() in device memory; null without terms with slopes.
  const double* row_sums() const { return frame_.sloped_terms() > 0 ? row_sums_.data() : nullptr; }
  /// Returns the sums of enqueue_gram() in device memory; null without terms of other kinds.
  const double* gram_sums() const {
    return frame_.difference_residual_count() > 0 ? gram_sums_.data() : nullptr;
  }
  /// Returns a number that changes whenever memory of the linearisation moves.
  std::uint64_t revision() const { return revision_; }

 private:
  /// Linearises points that are drawn together.
  void linearize_together(std::span<const Neighbourhood> points, std::vector<NormalEquations>& out);
  /// Takes for upload the drawn states of all points, then the states of each.
  void take(std::span<const Neighbourhood> points,
            const std::vector<std::vector<Eigen::Index>>& moved, int columns);
  /// Returns the layout of points that were taken.
  LinearizedStates taken(int points, int columns) const;
  void enqueue_all(const LinearizedStates& at);
  void enqueue_rows(const LinearizedStates& at);
  void enqueue_differences(const LinearizedStates& at);
  void download(const LinearizedStates& at);
  /// Makes room for so many objects. Counts the revision if memory moves, or would.
  template <class Buffer>
  void grow(Buffer& buffer, std::int64_t size) {
    if (static_cast<std::size_t>(size) > buffer.size()) ++revision_;
    buffer.reserve(static_cast<std::size_t>(size));
  }
  /// Returns the reciprocal steps of point `k`; 0 where a neighbour's cost is infinite.
  Eigen::VectorXd per_step(int k, int columns) const;

  Cost& cost_;
  FrameOnDevice& frame_;
  HostBatch batch_;
  RepeatedWork work_;
  std::uint64_t revision_ = 0;  // changes whenever memory below moves
  Eigen::VectorXd costs_;       // of the batch, by the terms without slopes; if these draw
  SideStream posing_, differences_;
  DeviceBuffer<float> numbers_;  // per point the reciprocal steps; then the blurs of all points
  PinnedBuffer<float> numbers_staging_;
  DeviceBuffer<PixelSlope> slopes_;
  DeviceBuffer<std::uint32_t> owners_;
  DeviceBuffer<float> records_, row_parts_;
  DeviceBuffer<float> residuals_, gram_parts_;  // of terms without slopes
  DeviceBuffer<double> row_sums_, gram_sums_;
  PinnedBuffer<double> row_sums_staging_, gram_sums_staging_;
};

}  // namespace internal
}  // namespace hypotrack::cuda
