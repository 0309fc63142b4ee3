#include "cost/cuda/host_batch.hpp"

#include <algorithm>
#include <limits>

#include "cost/backends.hpp"
#include "cost/cuda/memory/transfer.hpp"

namespace hypotrack::cuda::internal {

void HostBatch::take(const Eigen::MatrixXd& states, int cost_sets) {
  count_ = states.cols();
  cost_sets_ = cost_sets;
  const auto count = static_cast<std::size_t>(count_ * cost_sets);
  numbers_ = static_cast<std::size_t>(states.size());
  if (numbers_ > std::min(points_.size(), points_staging_.size()) ||
      count > std::min(costs_.size(), costs_staging_.size()))
    ++revision_;  // also if there is too little memory
  points_.reserve(numbers_);
  points_staging_.reserve(numbers_);
  costs_.reserve(count);
  costs_staging_.reserve(count);
  std::copy_n(states.data(), numbers_, points_staging_.data());
}

void HostBatch::upload(Stream stream) { to_device(points_, points_staging_, numbers_, stream); }

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
    for (Eigen::Index set = 1; set < cost_sets_; ++set)
      costs[i] += costs_staging_.data()[set * count_ + i];
    if (!(costs[i] >= std::numeric_limits<double>::lowest()))
      refuse_cost(terms.front(), i, "(or one after it) returned NaN or -infinity");
  }
}

}  // namespace hypotrack::cuda::internal
