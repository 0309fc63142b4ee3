#include "cost/cuda/linearize/gram_matrix.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "cost/cuda/linearize/device_residuals.hpp"
#include "device.hpp"

namespace hypotrack::cuda {
namespace {

struct Columns {
  Eigen::VectorXf here;
  Eigen::MatrixXf beside;
};

Columns random_columns(Eigen::Index rows, Eigen::Index dimension) {
  std::mt19937 random(static_cast<unsigned>(rows + dimension));
  std::normal_distribution<float> normal;
  Columns columns{Eigen::VectorXf(rows), Eigen::MatrixXf(rows, dimension)};
  for (float& x : columns.here) x = normal(random);
  columns.beside = columns.here.replicate(1, dimension);
  for (float& x : columns.beside.reshaped()) x += 0.1f * normal(random);
  return columns;
}

/// Inner products of the differences and, last, of `here`.
Eigen::MatrixXd products(const Columns& columns) {
  const Eigen::Index d = columns.beside.cols();
  Eigen::MatrixXd all(columns.here.size(), d + 1);
  all << (columns.beside.colwise() - columns.here).cast<double>(), columns.here.cast<double>();
  return all.transpose() * all;
}

TEST(GramMatrix, IsTakenApartIntoNormalEquations) {
  for (const int d : {1, 3, 4, 26, 27, 54}) {
    SCOPED_TRACE(d);
    const Eigen::MatrixXd all = products(random_columns(100, d));
    std::vector<double> sums;
    for (int a = 0; a < gram_sides(d); ++a) {
      for (int b = a; b < gram_sides(d); ++b) {
        for (int row = 4 * a; row < 4 * a + 4; ++row) {
          for (int column = 4 * b; column < 4 * b + 4; ++column) {
            sums.push_back(row <= d && column <= d ? all(row, column) : 0);
          }
        }
      }
    }
    ASSERT_EQ(sums.size(), static_cast<std::size_t>(gram_numbers(d)));
    Eigen::VectorXd scale = Eigen::VectorXd::LinSpaced(d, 0, -5);  // the first one is 0
    const NormalEquations found = unpack_gram(sums.data(), scale);
    const Eigen::MatrixXd a = scale.asDiagonal() * all.topLeftCorner(d, d) * scale.asDiagonal();
    EXPECT_LE((found.a - a).norm(), 1e-14 * a.norm());
    EXPECT_EQ(found.a, Eigen::MatrixXd(found.a.transpose()));
    const Eigen::VectorXd g = scale.cwiseProduct(all.col(d).head(d));
    EXPECT_LE((found.g - g).norm(), 1e-14 * g.norm());
  }
}

TEST(GramMatrix, ColumnsOfScaleZeroMayHoldAnything) {
  std::vector<double> sums(static_cast<std::size_t>(gram_numbers(2)), 2.0);
  for (const int k : {0, 1, 2, 4}) sums[static_cast<std::size_t>(k)] = NAN;  // of column 0
  const NormalEquations found = unpack_gram(sums.data(), Eigen::Vector2d(0, 1));
  EXPECT_EQ(found.a, Eigen::MatrixXd(Eigen::Vector2d(0, 2).asDiagonal()));
  EXPECT_EQ(found.g, Eigen::Vector2d(0, 2));
}

TEST(GramMatrix, OfTheGpuIsThatOfTheDenseJacobianAndRepeatsToTheBit) {
  SKIP_WITHOUT_DEVICE();
  for (const Eigen::Index rows : {0, 1, 31, 255, 256, 257, 5000, 100003}) {
    for (const int d : {1, 3, 4, 26, 27, 54, 131}) {
      SCOPED_TRACE(testing::Message() << rows << " x " << d);
      const Columns columns = random_columns(rows, d);
      const auto numbers = static_cast<std::size_t>(gram_numbers(d));
      const auto size = static_cast<std::size_t>(rows);
      DeviceBuffer<float> here(size + 1), beside(size * static_cast<std::size_t>(d) + 1);
      DeviceBuffer<float> parts(numbers * static_cast<std::size_t>(gram_blocks(rows)) + 1);
      DeviceBuffer<double> sums(numbers);
      check(cudaMemcpy(here.data(), columns.here.data(), size * sizeof(float), cudaMemcpyDefault),
            "uploading");
      check(cudaMemcpy(beside.data(), columns.beside.data(),
                       size * static_cast<std::size_t>(d) * sizeof(float), cudaMemcpyDefault),
            "uploading");
      const auto compute = [&] {
        enqueue_gram({here.data(), beside.data(), rows, d, parts.data(), sums.data()}, {});
        std::vector<double> out(numbers);
        check(cudaMemcpy(out.data(), sums.data(), numbers * sizeof(double), cudaMemcpyDefault),
              "downloading");
        return out;
      };
      const std::vector<double> found = compute();
      EXPECT_EQ(compute(), found);
      const Eigen::MatrixXd all = products(columns);
      const NormalEquations equations = unpack_gram(found.data(), Eigen::VectorXd::Ones(d));
      EXPECT_LE((equations.a - all.topLeftCorner(d, d)).norm(), 1e-6 * all.norm());
      EXPECT_LE((equations.g - all.col(d).head(d)).norm(), 1e-6 * all.norm());
    }
  }
}

}  // namespace
}  // namespace hypotrack::cuda
