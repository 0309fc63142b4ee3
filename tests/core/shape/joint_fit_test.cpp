#include "shape/joint_fit.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <random>

#include "hypotrack/api/error.hpp"

namespace hypotrack {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Frames whose residuals are A pose + B shape - b: the answer is known.
class Linear : public JointProblem {
 public:
  Linear(int frames, int poses, int shapes, const VectorXd& shape, double noise) : poses_(poses) {
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal;
    for (int k = 0; k < frames; ++k) {
      const MatrixXd j = MatrixXd::NullaryExpr(3 * (poses + shapes), poses + shapes,
                                               [&] { return normal(random); });
      const VectorXd pose = VectorXd::NullaryExpr(poses, [&] { return normal(random); });
      VectorXd all(poses + shapes);
      all << pose, shape;
      const VectorXd error = VectorXd::NullaryExpr(j.rows(), [&] { return normal(random); });
      jacobians_.push_back(j);
      targets_.push_back(j * all + noise * error);
    }
  }
  std::vector<FrameSystem> systems(const JointTrial& trial) override {
    ++systems_asked;
    std::vector<FrameSystem> systems;
    for (std::size_t k = 0; k < targets_.size(); ++k) {
      const VectorXd r = residuals(trial, k);
      systems.push_back({r.squaredNorm(), 2 * jacobians_[k].transpose() * r,
                         2 * jacobians_[k].transpose() * jacobians_[k]});
    }
    return systems;
  }
  VectorXd costs(const JointTrial& trial) override {
    VectorXd costs(static_cast<Eigen::Index>(targets_.size()));
    for (std::size_t k = 0; k < targets_.size(); ++k)
      costs[static_cast<Eigen::Index>(k)] = static_cast<int>(k) == blind
                                                ? std::numeric_limits<double>::infinity()
                                                : residuals(trial, k).squaredNorm();
    return costs;
  }
  VectorXd moved(const VectorXd& pose, const VectorXd& step) const override { return pose + step; }
  JointTrial start(int shapes) const {
    return {VectorXd::Ones(shapes), std::vector<VectorXd>(targets_.size(), VectorXd::Zero(poses_))};
  }
  int blind = -1;
  int systems_asked = 0;

 private:
  VectorXd residuals(const JointTrial& trial, std::size_t k) const {
    VectorXd all(trial.poses[k].size() + trial.shape.size());
    all << trial.poses[k], trial.shape;
    return jacobians_[k] * all - targets_[k];
  }
  int poses_;
  std::vector<MatrixXd> jacobians_;
  std::vector<VectorXd> targets_;
};

/// A problem with one more number of the shape, which no frame shows.
class Blind final : public JointProblem {
 public:
  explicit Blind(JointProblem& problem) : problem_(problem) {}
  std::vector<FrameSystem> systems(const JointTrial& trial) override {
    std::vector<FrameSystem> systems = problem_.systems(seen(trial));
    for (FrameSystem& system : systems) {
      const Eigen::Index size = system.gradient.size() + 1;
      system.gradient.conservativeResize(size);
      system.gradient[size - 1] = 0;
      system.hessian.conservativeResize(size, size);
      system.hessian.row(size - 1).setZero();
      system.hessian.col(size - 1).setZero();
    }
    return systems;
  }
  VectorXd costs(const JointTrial& trial) override { return problem_.costs(seen(trial)); }
  VectorXd moved(const VectorXd& pose, const VectorXd& step) const override { return pose + step; }

 private:
  static JointTrial seen(JointTrial trial) {
    trial.shape.conservativeResize(trial.shape.size() - 1);
    return trial;
  }
  JointProblem& problem_;
};

ShapePrior wide_prior(int shapes, double weight = 0) {
  return {VectorXd::Ones(shapes), VectorXd::Constant(shapes, -9), VectorXd::Constant(shapes, 9),
          100 * MatrixXd::Identity(shapes, shapes), weight};
}

const VectorXd kTrue = Eigen::Vector3d(1.1, 0.9, 1.02);

TEST(JointFit, FindsTheShapeThatAllFramesShare) {
  Linear problem(6, 5, 3, kTrue, 0);
  const JointFit fit = fit_jointly(problem, problem.start(3), wide_prior(3), 50);
  EXPECT_TRUE(fit.best.shape.isApprox(kTrue, 1e-3)) << fit.best.shape.transpose();
  EXPECT_LT(fit.cost, 1e-4 * fit.first_cost);
  EXPECT_LT(fit.iterations, 50);
}

TEST(JointFit, StaysNearThePriorAndWithinTheBounds) {
  Linear problem(6, 5, 3, kTrue, 0);
  const JointFit free = fit_jointly(problem, problem.start(3), wide_prior(3), 50);
  const JointFit held = fit_jointly(problem, problem.start(3), wide_prior(3, 1e6), 50);
  EXPECT_LT((held.best.shape - VectorXd::Ones(3)).norm(),
            0.1 * (free.best.shape - VectorXd::Ones(3)).norm());
  ShapePrior bounded = wide_prior(3);
  bounded.upper[0] = 1.05;
  const JointFit clipped = fit_jointly(problem, problem.start(3), bounded, 50);
  EXPECT_DOUBLE_EQ(clipped.best.shape[0], 1.05);
}

TEST(JointFit, FollowsThePriorsCorrelationsWhereFramesTellNothing) {
  Linear problem(6, 5, 2, Eigen::Vector2d(1.1, 1.1), 0);
  ShapePrior prior = wide_prior(3, 0.01);
  Eigen::Matrix3d covariance = 0.01 * Eigen::Matrix3d::Identity();
  covariance(2, 0) = covariance(0, 2) = 0.009;
  prior.precision = covariance.inverse();
  JointTrial start = problem.start(3);
  Blind blind(problem);
  const JointFit fit = fit_jointly(blind, start, prior, 50);
  EXPECT_NEAR(fit.best.shape[0], 1.1, 3e-3);
  EXPECT_NEAR(fit.best.shape[2], 1.09, 3e-3) << "1 + 0.9 times what the first is off";
}

TEST(JointFit, LeavesOutFramesWithoutACost) {
  Linear problem(6, 5, 3, kTrue, 0);
  problem.blind = 2;
  const JointFit fit = fit_jointly(problem, problem.start(3), wide_prior(3), 50);
  EXPECT_TRUE(fit.best.shape.isApprox(kTrue, 1e-3));
  Linear one(1, 5, 3, kTrue, 0);
  one.blind = 0;
  EXPECT_THROW(fit_jointly(one, one.start(3), wide_prior(3), 5), DataError);
}

/// One more frame, which tells nothing about the shape and gets worse wherever its pose goes.
class WithAStuckFrame final : public Linear {
 public:
  using Linear::Linear;
  std::vector<FrameSystem> systems(const JointTrial& trial) override {
    std::vector<FrameSystem> systems = Linear::systems(trial);
    const VectorXd numbers = VectorXd::Ones(systems.front().gradient.size());
    MatrixXd hessian = numbers.asDiagonal();
    hessian.bottomRows(trial.shape.size()).setZero();
    VectorXd gradient = numbers;
    gradient.tail(trial.shape.size()).setZero();
    systems.push_back({0, gradient, hessian});
    return systems;
  }
  VectorXd costs(const JointTrial& trial) override {
    const VectorXd others = Linear::costs(trial);
    VectorXd costs(others.size() + 1);
    costs << others, 1e6 * trial.poses.back().norm();
    return costs;
  }
};

TEST(JointFit, AFrameThatIsStuckStopsNoOther) {
  WithAStuckFrame problem(6, 5, 3, kTrue, 0);
  JointTrial start = problem.start(3);
  start.poses.push_back(VectorXd::Zero(5));
  const JointFit fit = fit_jointly(problem, start, wide_prior(3), 50);
  EXPECT_TRUE(fit.best.shape.isApprox(kTrue, 1e-3)) << fit.best.shape.transpose();
  EXPECT_EQ(fit.best.poses.back(), VectorXd::Zero(5));
}

TEST(JointFit, StopsWhenItIsTold) {
  Linear problem(6, 5, 3, kTrue, 0);
  const JointFit fit =
      fit_jointly(problem, problem.start(3), wide_prior(3), 50, [] { return true; });
  EXPECT_EQ(fit.iterations, 0);
  EXPECT_EQ(fit.best.shape, VectorXd::Ones(3));
}

}  // namespace
}  // namespace hypotrack
