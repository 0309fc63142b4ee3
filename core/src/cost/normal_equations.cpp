#include "cost/normal_equations.hpp"

#include <algorithm>
#include <cstring>
#include <vector>

namespace hypotrack {
namespace {

constexpr Eigen::Index kRows = 64;  // per block: half a row of a tile

/// One block of rows, with the columns that differ from r.
class Block {
 public:
  explicit Block(Eigen::Index columns) : j_(kRows, columns) {
    columns_.reserve(static_cast<std::size_t>(columns));
  }

  void take(const Eigen::Ref<const Eigen::VectorXf>& r,
            const Eigen::Ref<const Eigen::MatrixXf>& beside, const Eigen::VectorXd& scale,
            Eigen::Index row) {
    rows_ = std::min(kRows, r.size() - row);
    const auto bytes = static_cast<std::size_t>(rows_) * sizeof(float);
    columns_.clear();
    for (Eigen::Index d = 0; d < beside.cols(); ++d) {
      const float* column = beside.col(d).data() + row;
      if (scale[d] == 0 || std::memcmp(column, r.data() + row, bytes) == 0) continue;
      j_.col(static_cast<Eigen::Index>(columns_.size())).head(rows_) =
          (Eigen::Map<const Eigen::VectorXf>(column, rows_) - r.segment(row, rows_)) *
          static_cast<float>(scale[d]);
      columns_.push_back(d);
    }
  }

  void add_to(NormalEquations& sums, const Eigen::Ref<const Eigen::VectorXf>& r, Eigen::Index row) {
    const auto n = static_cast<Eigen::Index>(columns_.size());
    if (n == 0) return;
    const auto j = j_.topLeftCorner(rows_, n);
    product_.noalias() = j.transpose() * j;
    slope_.noalias() = j.transpose() * r.segment(row, rows_);
    for (Eigen::Index k = 0; k < n; ++k) {
      const Eigen::Index column = columns_[static_cast<std::size_t>(k)];
      sums.g[column] += slope_[k];
      for (Eigen::Index i = 0; i < n; ++i) {
        sums.a(columns_[static_cast<std::size_t>(i)], column) += product_(i, k);
      }
    }
  }

 private:
  Eigen::MatrixXf j_, product_;
  Eigen::VectorXf slope_;
  Eigen::Index rows_ = 0;
  std::vector<Eigen::Index> columns_;
};

}  // namespace

NormalEquations normal_equations(const Eigen::Ref<const Eigen::VectorXf>& r,
                                 const Eigen::Ref<const Eigen::MatrixXf>& beside,
                                 const Eigen::VectorXd& scale) {
  const Eigen::Index d = scale.size();
  NormalEquations sums{Eigen::MatrixXd::Zero(d, d), Eigen::VectorXd::Zero(d)};
  Block block(d);
  for (Eigen::Index row = 0; row < r.size(); row += kRows) {
    block.take(r, beside, scale, row);
    block.add_to(sums, r, row);
  }
  return sums;
}

Eigen::VectorXd scale_of_finite(const Eigen::Ref<const Eigen::VectorXd>& scale,
                                const Eigen::Ref<const Eigen::VectorXd>& costs) {
  return costs.array().isFinite().select(scale.array(), 0.0);
}

}  // namespace hypotrack
