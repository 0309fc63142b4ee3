#include "cost/cuda/linearize/device_residuals.hpp"

#include <algorithm>

#include "cost/cuda/linearize/gram_matrix.hpp"
#include "cost/cuda/memory/transfer.hpp"
#include "cost/linearize/difference_blocks.hpp"

namespace hypotrack::cuda::internal {

void DeviceResiduals::reserve(Eigen::Index states) {
  frame_.reserve(states, [&](std::int64_t count) {
    memory_.residuals.reserve(static_cast<std::size_t>(count * frame_.residual_count()));
  });
}

void DeviceResiduals::enqueue(const Eigen::MatrixXd& states) {
  frame_.device().use();
  reserve(states.cols());
  batch_.upload(states, frame_.stream());
  frame_.enqueue(batch_.layout(), memory_.residuals.data());
  batch_.download(0, states.cols(), frame_.stream());
}

void DeviceResiduals::finish(Eigen::Ref<Eigen::VectorXd> costs) {
  wait_for(frame_.stream(), "evaluating residuals");
  batch_.read(costs, frame_.terms());
}

void DeviceResiduals::evaluate(const Eigen::Ref<const Eigen::MatrixXd>& states,
                               Eigen::Ref<Eigen::VectorXd> costs) {
  const Eigen::MatrixXd& batch = cost_.normalized(states, costs.size());
  if (batch.cols() == 0) return;
  enqueue(batch);
  finish(costs);
}

void DeviceResiduals::move_to(Eigen::Index i) {
  const auto rows = static_cast<std::size_t>(frame_.residual_count());
  if (rows == 0) return;
  memory_.here.reserve(rows);
  check(cudaMemcpyAsync(memory_.here.data(),
                        memory_.residuals.data() + static_cast<std::size_t>(i) * rows,
                        rows * sizeof(float), cudaMemcpyDeviceToDevice, native(frame_.stream())),
        "copying residuals");
}

NormalEquations DeviceResiduals::normal_equations(const Eigen::Ref<const Eigen::MatrixXd>& states,
                                                  const Eigen::Ref<const Eigen::VectorXd>& scale,
                                                  Eigen::Ref<Eigen::VectorXd> costs) {
  const Eigen::MatrixXd& batch = cost_.normalized(states, costs.size());
  const auto dimension = static_cast<int>(batch.cols());
  const std::int64_t rows = frame_.residual_count();
  const auto numbers = static_cast<std::size_t>(gram_numbers(dimension));
  frame_.device().use();
  memory_.parts.reserve(numbers * static_cast<std::size_t>(gram_blocks(rows)));
  memory_.sums.reserve(numbers);
  memory_.sums_staging.reserve(numbers);
  enqueue(batch);
  enqueue_gram({memory_.here.data(), memory_.residuals.data(), rows, dimension,
                memory_.parts.data(), memory_.sums.data()},
               frame_.stream());
  to_host(memory_.sums_staging, memory_.sums, 0, numbers, frame_.stream());
  finish(costs);
  return unpack_gram(memory_.sums_staging.data(), scale_of_finite(scale, costs));
}

void DeviceResiduals::download(const Eigen::MatrixXd& states, Eigen::Ref<Eigen::MatrixXf> residuals,
                               Eigen::Ref<Eigen::VectorXd> costs) {
  const Eigen::Index rows = residuals.rows();
  const Eigen::Index most =
      std::max<Eigen::Index>(kMostBytes / std::max<Eigen::Index>(4 * rows, 1), 1);
  for (Eigen::Index first = 0; first < states.cols(); first += most) {
    const Eigen::Index count = std::min(most, states.cols() - first);
    enqueue(states.middleCols(first, count));
    const auto size = static_cast<std::size_t>(rows * count);
    memory_.residuals_staging.reserve(size);
    if (size > 0) to_host(memory_.residuals_staging, memory_.residuals, 0, size, frame_.stream());
    finish(costs.segment(first, count));
    residuals.middleCols(first, count) =
        Eigen::Map<const Eigen::MatrixXf>(memory_.residuals_staging.data(), rows, count);
  }
}

NormalEquations unpack_gram(const double* sums, const Eigen::Ref<const Eigen::VectorXd>& scale) {
  const auto dimension = static_cast<int>(scale.size());
  NormalEquations out{Eigen::MatrixXd::Zero(dimension, dimension),
                      Eigen::VectorXd::Zero(dimension)};
  const auto put = [&](int row, int column, double sum) {
    if (row >= dimension || column > dimension || scale[row] == 0) return;
    if (column == dimension) {
      out.g[row] = scale[row] * sum;
    } else if (scale[column] != 0) {
      out.a(row, column) = out.a(column, row) = scale[row] * scale[column] * sum;
    }
  };
  for (int a = 0; a < gram_sides(dimension); ++a) {
    for (int b = a; b < gram_sides(dimension); ++b) {
      for (int k = 0; k < kGramSquare; ++k) {
        put(kGramSide * a + k / kGramSide, kGramSide * b + k % kGramSide, *sums++);
      }
    }
  }
  return out;
}

}  // namespace hypotrack::cuda::internal
