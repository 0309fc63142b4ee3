#include "cost/cuda/host_batch.hpp"

#include <algorithm>
#include <limits>

#include "cost/backends.hpp"
#include "cost/cuda/transfer.hpp"

namespace hypotrack::cuda::internal {

void HostBatch::upload(const Eigen::MatrixXd& states, Stream stream) {
  count_ = states.cols();
  const auto count = static_cast<std::size_t>(count_);
  const auto size = static_cast<std::size_t>(states.size());
  points_.reserve(size);
  points_staging_.reserve(size);
  costs_.reserve(count);
  costs_staging_.reserve(count);
  std::copy_n(states.data(), size, points_staging_.data());
  to_device(points_, points_staging_, size, stream);
}

BatchLayout HostBatch::layout() const {
  return {points_.data(), count_, costs_.data(), 0, nullptr, false};
}

void HostBatch::download(Eigen::Index first, Eigen::Index count, Stream stream) {
  to_host(costs_staging_, costs_, static_cast<std::size_t>(first), static_cast<std::size_t>(count),
          stream);
}

void HostBatch::read(Eigen::Ref<Eigen::VectorXd> costs,
                     const std::vector<ObjectiveTerm>& terms) const {
  for (Eigen::Index i = 0; i < count_; ++i) {
    costs[i] = costs_staging_.data()[i];
    if (!(costs[i] >= std::numeric_limits<double>::lowest()))
      refuse_cost(terms.front(), i, "(or one after it) returned NaN or -infinity");
  }
}

}  // namespace hypotrack::cuda::internal
