// The kernels of a search by least squares, step by step beside the search on the host.
#include "cost/cuda/descend/descent_kernels.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "cost/cuda/linearize/gram_matrix.hpp"
#include "cost/cuda/linearize/pixel_rows.hpp"
#include "damped_least_squares.hpp"
#include "device.hpp"
#include "device_scores.hpp"
#include "hypotrack/gpu/runtime.cuh"
#include "observations.hpp"
#include "track/search/search_space.hpp"

namespace hypotrack::cuda {
namespace {

template <class T>
void upload(const DeviceBuffer<T>& to, const std::vector<T>& from) {
  check(cudaMemcpy(to.data(), from.data(), from.size() * sizeof(T), cudaMemcpyDefault), "upload");
}
template <class T>
std::vector<T> downloaded(const DeviceBuffer<T>& from) {
  std::vector<T> out(from.size());
  check(cudaDeviceSynchronize(), "waiting");
  check(cudaMemcpy(out.data(), from.data(), out.size() * sizeof(T), cudaMemcpyDefault), "download");
  return out;
}

/// Memory of one search of a scene.
class Kernels {
 public:
  Kernels(const Scene& scene, const SearchRegion& region, const DampedSettings& settings,
          const Eigen::VectorXd& prior)
      : d_(static_cast<std::size_t>(region.start.size())),
        s_(static_cast<std::size_t>(scene.dimension())),
        trials_(static_cast<std::size_t>(settings.trials)) {
    std::vector<ModelLayout> models;
    for (const Scene::Item& item : scene.items())
      models.push_back({item.offset, item.model->dimension()});
    models_.reserve(models.size());
    upload(models_, models);
    prior_.reserve(s_);
    upload(prior_, std::vector<double>(prior.begin(), prior.end()));
    std::vector<double> regions;
    for (const auto* part : {&region.start, &region.lower, &region.upper, &region.spread})
      regions.insert(regions.end(), part->begin(), part->end());
    regions_.reserve(regions.size());
    upload(regions_, regions);
    states_.reserve(1), rests_.reserve(1), blurs_.reserve(1), answer_.reserve(1);
    points_.reserve((2 + trials_) * d_), trial_states_.reserve(trials_ * s_);
    costs_.reserve(2 * trials_), centres_.reserve((d_ + 2) * s_), per_step_.reserve(d_);
    rows_.reserve(static_cast<std::size_t>(row_numbers(static_cast<int>(d_))));
    grams_.reserve(static_cast<std::size_t>(gram_numbers(static_cast<int>(d_))));
    answer_point_.reserve(d_);
    enqueue_begin(job(), settings, {});
  }

  /// Takes costs, each the sum of two.
  void take(const Eigen::VectorXd& costs) {
    std::vector<double> sets(2 * trials_, NAN);
    for (std::size_t i = 0; i < static_cast<std::size_t>(costs.size()); ++i) {
      sets[i] = costs[static_cast<Eigen::Index>(i)] - 1;
      sets[trials_ + i] = 1;
    }
    upload(costs_, sets);
    enqueue_costs_taken(job(), {});
  }
  /// Takes equations, half of them as rows of pixels and half as differences.
  void take(const NormalEquations& equations) {
    const auto d = static_cast<Eigen::Index>(d_);
    Eigen::MatrixXd half(d + 1, d + 1);
    half << equations.a / 2, equations.g / 2, equations.g.transpose() / 2, 0;
    upload(rows_, packed(half, kRowSide, rows_.size(), false));
    const std::vector<float> per_step = downloaded(per_step_);
    for (Eigen::Index i = 0; i < d; ++i) {
      const double scale = per_step[static_cast<std::size_t>(i)];
      half.row(i) /= scale;
      half.col(i) /= scale;
    }
    upload(grams_, packed(half, kGramSide, grams_.size(), true));
    enqueue_trials(job(), {});
  }

  Eigen::MatrixXd trial_points(Eigen::Index count) const {
    const std::vector<double> all = downloaded(points_);
    return Eigen::Map<const Eigen::MatrixXd>(all.data() + 2 * d_, static_cast<Eigen::Index>(d_),
                                             count);
  }
  Eigen::MatrixXd trial_states() const { return matrix(trial_states_); }
  /// Returns the centre's state, then it again and its neighbours'.
  Eigen::MatrixXd centres() const { return matrix(centres_); }
  std::vector<float> per_step() const { return downloaded(per_step_); }
  float blur() const { return downloaded(blurs_)[0]; }
  bool rests() const { return downloaded(rests_)[0] != 0; }
  const DescentAnswer& answer() const {
    check(cudaDeviceSynchronize(), "waiting");
    return *answer_.data();
  }
  Eigen::VectorXd answer_point() const {
    return Eigen::Map<const Eigen::VectorXd>(answer_point_.data(), static_cast<Eigen::Index>(d_));
  }

 private:
  DescentJob job() const {
    return {1,
            static_cast<int>(d_),
            static_cast<int>(trials_),
            static_cast<int>(s_),
            static_cast<int>(models_.size()),
            models_.data(),
            prior_.data(),
            regions_.data(),
            states_.data(),
            points_.data(),
            trial_states_.data(),
            costs_.data(),
            2,
            centres_.data(),
            per_step_.data(),
            blurs_.data(),
            rests_.data(),
            rows_.data(),
            grams_.data(),
            answer_.data(),
            answer_point_.data()};
  }
  /// Returns the squares on and above the diagonal of a matrix.
  static std::vector<double> packed(const Eigen::MatrixXd& m, int side, std::size_t size,
                                    bool by_rows) {
    std::vector<double> out;
    const auto sides = (static_cast<int>(m.rows()) + side - 1) / side;
    for (int a = 0; a < sides; ++a)
      for (int b = a; b < sides; ++b)
        for (int k = 0; k < side * side; ++k) {
          const int i = side * a + (by_rows ? k / side : k % side);
          const int j = side * b + (by_rows ? k % side : k / side);
          out.push_back(i < m.rows() && j < m.cols() && i <= j ? m(i, j) : 0);
        }
    EXPECT_EQ(out.size(), size);
    return out;
  }
  Eigen::MatrixXd matrix(const DeviceBuffer<double>& states) const {
    const std::vector<double> all = downloaded(states);
    return Eigen::Map<const Eigen::MatrixXd>(all.data(), static_cast<Eigen::Index>(s_),
                                             static_cast<Eigen::Index>(all.size() / s_));
  }

  std::size_t d_, s_, trials_;
  DeviceBuffer<ModelLayout> models_;
  DeviceBuffer<double> prior_, regions_, points_, trial_states_, costs_, centres_, rows_, grams_;
  DeviceBuffer<DescentState> states_;
  DeviceBuffer<float> per_step_, blurs_;
  DeviceBuffer<std::int32_t> rests_;
  PinnedBuffer<DescentAnswer> answer_;
  PinnedBuffer<double> answer_point_;
};

/// Made-up costs and equations.
class MadeUp {
 public:
  explicit MadeUp(unsigned seed) : random_(seed) {}
  /// Returns costs about a falling level: some trials help, others do not.
  Eigen::VectorXd costs(Eigen::Index count) {
    level_ *= 0.98;
    return Eigen::VectorXd::NullaryExpr(count,
                                        [&] { return level_ * (1 + 0.03 * normal_(random_)); });
  }
  NormalEquations equations(const SearchRegion& region) {
    const Eigen::Index d = region.start.size();
    Eigen::MatrixXd j = Eigen::MatrixXd::NullaryExpr(2 * d, d, [&] { return normal_(random_); });
    j = j * region.spread.cwiseInverse().asDiagonal();
    j.col(d / 2).setZero();  // nothing depends on it
    const Eigen::VectorXd r = Eigen::VectorXd::NullaryExpr(2 * d, [&] { return normal_(random_); });
    return {j.transpose() * j, j.transpose() * r};
  }

 private:
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
  double level_ = 100;
};

/// Compares a search on the host with that of the kernels, at equal costs and equations.
class Comparison {
 public:
  Comparison(const Scene& scene, const LevenbergMarquardtParams& params, std::int64_t evaluations)
      : scene_(scene), params_(params), evaluations_(evaluations) {
    SearchSettings settings;
    settings.rotation_as = RotationCoordinates::tangent;
    space_ = SearchSpace(scene_, settings);
    prior_ = test::scored_states(scene_).col(0);
    region_ = space_.region(prior_);
  }

  void run(unsigned seed) {
    using Source = DampedLeastSquares::Source;
    MadeUp made_up(seed);
    DampedLeastSquares host(region_, evaluations_, params_, Source::analytic);
    Kernels kernels(scene_, region_,
                    damped_settings(params_, Source::analytic, evaluations_, space_.dimension()),
                    prior_);
    last_ = made_up.equations(region_);
    for (int step = 0; host.wants() != DampedLeastSquares::Wants::nothing; ++step) {
      SCOPED_TRACE(step);
      expect_trials(host, kernels);
      const Eigen::VectorXd costs = made_up.costs(host.points().cols());
      host.take(costs);
      kernels.take(costs);
      const bool linearizes = host.wants() == DampedLeastSquares::Wants::equations;
      EXPECT_EQ(kernels.rests(), !linearizes);
      if (linearizes) {
        expect_neighbours(host.neighbourhood(), kernels);
        last_ = made_up.equations(region_);
        host.take(last_);
      }
      kernels.take(last_);
    }
    EXPECT_EQ(kernels.answer().ended, 1);
    EXPECT_EQ(kernels.answer().refused, 0);
    EXPECT_EQ(kernels.answer().evaluations, host.result().evaluations);
    EXPECT_EQ(kernels.answer().cost, host.result().cost);
    EXPECT_LT(largest(kernels.answer_point() - host.result().point), 1e-9);
    EXPECT_TRUE(kernels.trial_states().array().isNaN().all());
  }

 private:
  double largest(const Eigen::VectorXd& difference) const {
    return difference.cwiseQuotient(region_.spread).cwiseAbs().maxCoeff();
  }
  void expect_trials(const DampedLeastSquares& host, const Kernels& kernels) const {
    const Eigen::Index count = host.points().cols();
    const Eigen::MatrixXd points = kernels.trial_points(count), states = kernels.trial_states();
    for (Eigen::Index i = 0; i < count; ++i)
      EXPECT_LT(largest(points.col(i) - host.points().col(i)), 1e-9);
    const Eigen::MatrixXd expected = space_.states(host.points(), prior_);
    EXPECT_LT((states.leftCols(count) - expected).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_TRUE(states.rightCols(states.cols() - count).array().isNaN().all());
  }
  void expect_neighbours(const Neighbourhood& at, const Kernels& kernels) const {
    const Eigen::MatrixXd found = kernels.centres();
    const Eigen::MatrixXd expected = space_.states(at.points, prior_);
    EXPECT_LT((found.rightCols(expected.cols()) - expected).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_EQ(found.col(0), found.col(1));
    EXPECT_EQ(kernels.blur(), static_cast<float>(at.blur));
    const std::vector<float> per_step = kernels.per_step();
    for (std::size_t i = 0; i < per_step.size(); ++i) {
      const double step = at.steps[static_cast<Eigen::Index>(i)];
      EXPECT_NEAR(per_step[i] * step, step != 0 ? 1 : 0, 1e-6);
    }
  }

  Scene scene_;
  LevenbergMarquardtParams params_;
  std::int64_t evaluations_;
  SearchSpace space_{scene_, {}};
  Eigen::VectorXd prior_;
  SearchRegion region_;
  NormalEquations last_;  ///< of the kernels
};

class DescentKernels : public testing::Test {
 protected:
  void SetUp() override { SKIP_WITHOUT_DEVICE(); }
};

TEST_F(DescentKernels, GoTheWayOfTheHost) {
  LevenbergMarquardtParams stage;
  stage.mean_share = 0;
  stage.tolerance = 0.03;
  for (const unsigned seed : {1u, 2u, 3u}) {
    SCOPED_TRACE(seed);
    Comparison(test::hand_scene(), stage, 307).run(seed);
    Comparison(test::hand_and_box_scene(), {}, 150).run(seed);
  }
}

TEST_F(DescentKernels, EndWithTheBudget) {
  LevenbergMarquardtParams params;
  params.finest = 1e-3;
  for (const std::int64_t evaluations : {1, 2, 3, 4, 5, 6, 8, 9, 11, 40}) {
    SCOPED_TRACE(evaluations);
    Comparison(test::hand_scene(), params, evaluations).run(7);
  }
  params.iterations = 2;
  Comparison(test::hand_scene(), params, 100).run(8);
}

TEST_F(DescentKernels, RefuseCostsThatAreNoNumbers) {
  const Scene scene = test::hand_scene();
  const SearchSpace space(scene, {});
  const Eigen::VectorXd prior = test::scored_states(scene).col(0);
  Kernels kernels(scene, space.region(prior), {.evaluations = 100}, prior);
  kernels.take(Eigen::VectorXd::Constant(1, NAN));
  EXPECT_EQ(kernels.answer().ended, 1);
  EXPECT_EQ(kernels.answer().refused, 1);
}

}  // namespace
}  // namespace hypotrack::cuda
