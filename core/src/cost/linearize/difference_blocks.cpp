#include "cost/linearize/difference_blocks.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cstring>
#include <utility>

namespace hypotrack::internal {
namespace {

constexpr std::size_t kRows = 64;  // per block: half a row of a tile
// Blocks are summed in this many parts at the same time. The number is fixed, so that the sums do
// not depend on the number of threads.
constexpr std::size_t kParts = 16;

std::size_t block_count(std::size_t rows) { return (rows + kRows - 1) / kRows; }

}  // namespace

void DifferenceBlocks::begin(std::span<const float> here, Eigen::Index columns) {
  here_.resize(block_count(here.size()) * kRows);
  std::fill(std::ranges::copy(here, here_.begin()).out, here_.end(), 0.0f);
  columns_.resize(static_cast<std::size_t>(columns));
  for (Column& column : columns_) {
    column.blocks.clear();
    column.differences.clear();
  }
}

void DifferenceBlocks::set(Eigen::Index i, std::span<const float> residuals) {
  Column& column = columns_[static_cast<std::size_t>(i)];
  column.blocks.clear();
  column.differences.clear();
  for (std::size_t row = 0; row < residuals.size(); row += kRows) {
    const std::size_t rows = std::min(kRows, residuals.size() - row);
    const float *there = residuals.data() + row, *here = here_.data() + row;
    if (std::memcmp(there, here, rows * sizeof(float)) == 0) continue;
    column.blocks.push_back(static_cast<std::uint32_t>(row / kRows));
    const std::size_t first = column.differences.size();
    column.differences.resize(first + kRows);
    using Rows = Eigen::Map<const Eigen::VectorXf>;
    const auto size = static_cast<Eigen::Index>(rows);
    Eigen::Map<Eigen::VectorXf>(column.differences.data() + first, size) =
        Rows(there, size) - Rows(here, size);
  }
}

/// The sums over consecutive blocks.
class DifferenceBlocks::Sum {
 public:
  Sum() = default;
  Sum(const DifferenceBlocks& all, const Eigen::VectorXd& scale, std::size_t first, std::size_t end)
      : sums_{Eigen::MatrixXd::Zero(scale.size(), scale.size()),
              Eigen::VectorXd::Zero(scale.size())},
        j_(kRows, scale.size()) {
    std::vector<std::size_t> next;  // per column: the first of its blocks that is not summed
    for (const Column& column : all.columns_) {
      const auto at = std::ranges::lower_bound(column.blocks, first);
      next.push_back(static_cast<std::size_t>(at - column.blocks.begin()));
    }
    for (std::size_t block = first; block < end; ++block) {
      gather(all, scale, block, next);
      if (!present_.empty()) add(all.here_.data() + block * kRows);
    }
  }

  const NormalEquations& sums() const { return sums_; }

 private:
  void gather(const DifferenceBlocks& all, const Eigen::VectorXd& scale, std::size_t block,
              std::vector<std::size_t>& next) {
    present_.clear();
    for (std::size_t d = 0; d < all.columns_.size(); ++d) {
      const Column& column = all.columns_[d];
      if (next[d] == column.blocks.size() || column.blocks[next[d]] != block) continue;
      const float* differences = column.differences.data() + kRows * next[d]++;
      const auto dimension = static_cast<Eigen::Index>(d);
      if (scale[dimension] == 0) continue;
      j_.col(static_cast<Eigen::Index>(present_.size())) =
          Eigen::Map<const Eigen::VectorXf>(differences, kRows) *
          static_cast<float>(scale[dimension]);
      present_.push_back(dimension);
    }
  }

  void add(const float* here) {
    const auto n = static_cast<Eigen::Index>(present_.size());
    const auto j = j_.leftCols(n);
    product_.noalias() = j.transpose() * j;
    slope_.noalias() = j.transpose() * Eigen::Map<const Eigen::VectorXf>(here, kRows);
    for (Eigen::Index k = 0; k < n; ++k) {
      const Eigen::Index column = present_[static_cast<std::size_t>(k)];
      sums_.g[column] += slope_[k];
      for (Eigen::Index i = 0; i < n; ++i) {
        sums_.a(present_[static_cast<std::size_t>(i)], column) += product_(i, k);
      }
    }
  }

  NormalEquations sums_;
  Eigen::MatrixXf j_, product_;
  Eigen::VectorXf slope_;
  std::vector<Eigen::Index> present_;  // dimensions of the columns of j_
};

std::vector<std::size_t> DifferenceBlocks::equal_parts(std::size_t count) const {
  std::vector<std::size_t> work(here_.size() / kRows + 1);  // then: work before a block
  for (const Column& column : columns_) {
    for (const std::uint32_t block : column.blocks) ++work[block];
  }
  std::size_t sum = 0;
  for (std::size_t& of_block : work) {
    const std::size_t columns = std::exchange(of_block, sum);
    sum += columns * (columns + 4);
  }
  std::vector<std::size_t> first;
  for (std::size_t i = 0; i < count; ++i) {
    const auto at = std::ranges::lower_bound(work, i * sum / count);
    first.push_back(static_cast<std::size_t>(at - work.begin()));
  }
  first.push_back(work.size() - 1);
  return first;
}

NormalEquations DifferenceBlocks::normal_equations(
    const Eigen::Ref<const Eigen::VectorXd>& scale) const {
  const std::vector<std::size_t> first = equal_parts(kParts);
  std::vector<Sum> parts(kParts);
  tbb::parallel_for(std::size_t{0}, kParts,
                    [&](std::size_t i) { parts[i] = Sum(*this, scale, first[i], first[i + 1]); });
  NormalEquations sums = parts[0].sums();
  for (std::size_t i = 1; i < kParts; ++i) {
    sums.a += parts[i].sums().a;
    sums.g += parts[i].sums().g;
  }
  return sums;
}

NormalEquations normal_equations(const Eigen::Ref<const Eigen::VectorXf>& r,
                                 const Eigen::Ref<const Eigen::MatrixXf>& beside,
                                 const Eigen::VectorXd& scale) {
  const auto rows = static_cast<std::size_t>(r.size());
  DifferenceBlocks differences;
  differences.begin({r.data(), rows}, beside.cols());
  for (Eigen::Index i = 0; i < beside.cols(); ++i) {
    differences.set(i, {beside.col(i).data(), rows});
  }
  return differences.normal_equations(scale);
}

Eigen::VectorXd scale_of_finite(const Eigen::Ref<const Eigen::VectorXd>& scale,
                                const Eigen::Ref<const Eigen::VectorXd>& costs) {
  return costs.array().isFinite().select(scale.array(), 0.0);
}

}  // namespace hypotrack::internal
