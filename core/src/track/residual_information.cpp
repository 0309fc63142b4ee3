#include <algorithm>
#include <cstring>
#include <vector>

#include "track/uncertainty.hpp"

namespace hypotrack::internal {
namespace {

constexpr Eigen::Index kRows = 64;  // per block: half a row of a tile
// Floor of s^2: all-zero residuals would claim perfect knowledge, which floats cannot have.
constexpr double kLeastNoise = 1e-12;

/// Adds up blocks of residuals. Most residuals do not depend on most dimensions: equal values on
/// both sides of a pose cost only a comparison.
class Sums {
 public:
  Sums(const Eigen::MatrixXf& residuals, const Eigen::VectorXd& width)
      : residuals_(residuals), width_(width), j_(kRows, width.size()) {
    a_.setZero(width.size(), width.size());
    g_.setZero(width.size());
  }

  void add(Eigen::Index row) {
    rows_ = std::min(kRows, residuals_.rows() - row);
    take_columns(row);
    if (columns_.empty()) return;
    const auto j = j_.topLeftCorner(rows_, static_cast<Eigen::Index>(columns_.size()));
    const auto r = residuals_.col(0).segment(row, rows_);
    const Eigen::MatrixXd product = (j.transpose() * j).cast<double>();
    const Eigen::VectorXd slope = (j.transpose() * r).cast<double>();
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      const auto column = static_cast<Eigen::Index>(k);
      g_[columns_[k]] += slope[column];
      for (std::size_t i = 0; i < columns_.size(); ++i)
        a_(columns_[i], columns_[k]) += product(static_cast<Eigen::Index>(i), column);
    }
    for (Eigen::Index i = 0; i < rows_; ++i) {
      if (j.row(i).isZero(0)) continue;
      squares_ += static_cast<double>(r[i]) * r[i];
      ++touched_;
    }
  }

  ResidualInformation divided() const {
    if (touched_ == 0) return {a_, g_};
    const double noise = std::max(squares_ / static_cast<double>(touched_), kLeastNoise);
    return {a_ / noise, g_ / noise};
  }

 private:
  /// Computes the non-zero columns of J for a block.
  void take_columns(Eigen::Index row) {
    columns_.clear();
    const auto bytes = static_cast<std::size_t>(rows_) * sizeof(float);
    for (Eigen::Index d = 0; d < width_.size(); ++d) {
      const float* below = residuals_.col(2 * d + 1).data() + row;
      const float* above = residuals_.col(2 * d + 2).data() + row;
      if (!(width_[d] > 0) || std::memcmp(below, above, bytes) == 0) continue;
      j_.col(static_cast<Eigen::Index>(columns_.size())).head(rows_) =
          (Eigen::Map<const Eigen::VectorXf>(above, rows_) -
           Eigen::Map<const Eigen::VectorXf>(below, rows_)) /
          static_cast<float>(width_[d]);
      columns_.push_back(d);
    }
  }

  const Eigen::MatrixXf& residuals_;
  const Eigen::VectorXd& width_;
  Eigen::MatrixXf j_;
  Eigen::Index rows_ = 0;
  std::vector<Eigen::Index> columns_;
  Eigen::MatrixXd a_;
  Eigen::VectorXd g_;
  double squares_ = 0;
  std::int64_t touched_ = 0;
};

}  // namespace

ResidualInformation residual_information(const Eigen::MatrixXf& residuals,
                                         const Eigen::VectorXd& width) {
  Sums sums(residuals, width);
  for (Eigen::Index row = 0; row < residuals.rows(); row += kRows) sums.add(row);
  return sums.divided();
}

}  // namespace hypotrack::internal
