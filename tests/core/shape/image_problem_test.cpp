#include "shape/image_problem.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "shaped_model.hpp"

namespace hypotrack {
namespace {

constexpr int kTile = 96;

/// Pixels of the first view that are covered.
std::vector<bool> coverage_of(const DepthTile& tile) {
  std::vector<bool> covered(static_cast<std::size_t>(tile.width) * tile.height, false);
  for (int y = tile.y0; y < tile.y1; ++y)
    for (int x = tile.x0; x < tile.x1; ++x)
      covered[static_cast<std::size_t>(y) * tile.width + x] =
          tile.inverse_depth[static_cast<std::ptrdiff_t>(y) * tile.stride + x] > 0;
  return covered;
}

/// Without the pixels at the edge: those that have a neighbour outside.
std::vector<bool> eroded(const std::vector<bool>& covered) {
  std::vector<bool> inner(covered.size(), false);
  for (std::size_t i = kTile; i + kTile < covered.size(); ++i)
    inner[i] =
        covered[i] && covered[i - 1] && covered[i + 1] && covered[i - kTile] && covered[i + kTile];
  return inner;
}

/// What the true hand covers, by frame. A covered pixel explains 1 where the hand is and
/// `elsewhere` where it is not. With `mixed_edges` those at the edge of the hand are elsewhere.
class Silhouette final : public Objective, public ResidualTerm {
 public:
  explicit Silhouette(double elsewhere, bool mixed_edges = false)
      : elsewhere_(elsewhere), mixed_edges_(mixed_edges) {}
  bool learning = false;
  mutable std::map<int, std::vector<bool>> targets;

 private:
  void do_prepare(const Observation& observation) override { frame_ = observation.frame; }
  double do_cost(const RenderedHypothesis& h) const override {
    const std::vector<bool> covered = coverage_of(h.views[0]);
    if (learning) targets[frame_] = mixed_edges_ ? eroded(covered) : covered;
    const std::vector<bool>& target = targets[frame_];
    double cost = 0;
    for (std::size_t i = 0; i < covered.size(); ++i)
      if (covered[i]) cost -= target[i] ? 1 : elsewhere_;
    return cost;
  }
  const ResidualTerm* do_residual_term() const override { return this; }
  std::int64_t do_residual_count() const override { return kTile * kTile; }
  void do_write_residuals(const RenderedHypothesis& h, std::span<float> residuals) const override {
    const std::vector<bool> covered = coverage_of(h.views[0]);
    const std::vector<bool>& target = targets.at(frame_);
    for (std::size_t i = 0; i < covered.size(); ++i) {
      const double s = covered[i] ? (target[i] ? 1 : elsewhere_) : 0;
      residuals[i] = static_cast<float>(std::sqrt(1 - s));
    }
  }

  double elsewhere_;
  bool mixed_edges_;
  int frame_ = 0;
};

/// Remembers how bright the second view is, and counts the frames.
class Brightness final : public Objective, public ResidualTerm {
 public:
  double second_view = 0;
  int prepared = 0;

 private:
  void do_prepare(const Observation& observation) override {
    second_view = observation.views[1].color.at<cv::Vec3b>(kTile / 2, kTile / 2)[0];
    ++prepared;
  }
  double do_cost(const RenderedHypothesis&) const override { return 0; }
  const ResidualTerm* do_residual_term() const override { return this; }
  std::int64_t do_residual_count() const override { return 0; }
  void do_write_residuals(const RenderedHypothesis&, std::span<float>) const override {}
};

/// A hand of another shape in four postures before a pair of cameras.
class ShapeFromImages : public ::testing::Test {
 protected:
  void SetUp() override {
    Camera camera{640, 480, 600, 600, 319.5, 239.5, DistortionModel::none, {}, {}};
    camera.camera_from_world = Eigen::Isometry3d::Identity();
    parts_.cameras = {camera, camera};
    parts_.cameras[1].camera_from_world.translation().x() = -0.06;
    parts_.tile.size = kTile;
    parts_.evaluate = {.backend = Backend::cpu, .threads = 1};
    const Eigen::Quaterniond palm(Eigen::AngleAxisd(EIGEN_PI, Eigen::Vector3d::UnitX()));
    for (int k = 0; k < 4; ++k) {
      const Eigen::Quaterniond q =
          Eigen::Quaterniond(
              Eigen::AngleAxisd(0.4 * (k - 1.5), Eigen::Vector3d(0.3, 1, 0.2).normalized())) *
          palm;
      Eigen::VectorXd state = scene_.rest_state();
      state.head<7>() << 0, 0.08, 0.5, q.w(), q.x(), q.y(), q.z();
      for (int i = 8; i < 27; ++i) state[i] = 0.05 * ((i * 7 + k * 5) % 6);
      Frame frame;
      frame.index = k;
      frame.views.assign(2, View{.color = cv::Mat(480, 640, CV_8UC3, cv::Scalar::all(90))});
      frames_.push_back({frame, state});
    }
  }

  /// The joint fit of neutral hands that begin at the true poses.
  JointFit fit(const std::shared_ptr<Silhouette>& silhouette, double coverage, double edge = 0) {
    parts_.objective = {{.objective = silhouette}};
    parts_.coverage = coverage;
    parts_.edge = edge;
    learn(*silhouette);
    const ShapeTargets targets(scene_, {}, {});
    ImageProblem problem(scene_, targets, parts_, frames_);
    const Eigen::Vector2d deviation(0.07, 0.05);
    const ShapePrior prior{Eigen::Vector2d(1, 1), Eigen::Vector2d(0.7, 0.75),
                           Eigen::Vector2d(1.35, 1.3),
                           deviation.cwiseAbs2().cwiseInverse().asDiagonal().toDenseMatrix(), 1};
    problem.set_steps(2);
    JointFit fit = fit_jointly(problem, problem.start(), prior, 10);
    problem.set_steps(1);
    return fit_jointly(problem, fit.best, prior, 5);
  }

  const Scene scene_ = test::shaped_scene();
  ImageProblemParts parts_;
  std::vector<TrackedFrame> frames_;

 private:
  void learn(Silhouette& silhouette) {
    const auto silhouettes =
        make_cost(truth_, {{.objective = {&silhouette, [](Objective*) {}}}}, parts_.evaluate);
    const TileMaker tiles(scene_, parts_.cameras, parts_.tile);
    silhouette.learning = true;
    for (const TrackedFrame& f : frames_) {
      silhouettes->prepare(tiles, f.frame, tiles.plan(f.frame, f.state));
      Eigen::VectorXd cost(1);
      silhouettes->evaluate(f.state, cost);
    }
    silhouette.learning = false;
  }
  const Scene truth_ = test::shaped_scene({1.06, 0.93});
};

TEST_F(ShapeFromImages, IsFoundWithThePoses) {
  const JointFit found = fit(std::make_shared<Silhouette>(0), 0.5);
  EXPECT_NEAR(found.best.shape[0], 1.06, 0.012);
  EXPECT_NEAR(found.best.shape[1], 0.93, 0.025);
}

TEST_F(ShapeFromImages, GrowsUnlessCoverageIsCharged) {
  constexpr double kAlike = 0.3;  // of what the hand explains the background does as well
  EXPECT_GT(fit(std::make_shared<Silhouette>(kAlike), 0).best.shape[0], 1.2);
  EXPECT_NEAR(fit(std::make_shared<Silhouette>(kAlike), 0.5).best.shape[0], 1.06, 0.015);
}

TEST_F(ShapeFromImages, IsNotSmallerForPixelsAtEdgesThatMatchNothing) {
  const auto silhouette = std::make_shared<Silhouette>(0, true);
  // A pixel across edges along rows and columns, 1 / sqrt(2) across diagonal ones.
  constexpr double kEroded = 0.9;
  EXPECT_LT(fit(silhouette, 0.5).best.shape[0], 1.03);
  EXPECT_NEAR(fit(silhouette, 0.5, kEroded).best.shape[0], 1.06, 0.012);
}

TEST_F(ShapeFromImages, IsSoughtInColoursThatAreMatched) {
  const auto brightness = std::make_shared<Brightness>();
  parts_.objective = {{.objective = brightness}};
  for (TrackedFrame& f : frames_)
    f.frame.views[1].color = cv::Mat(480, 640, CV_8UC3, cv::Scalar::all(99));
  const ShapeTargets targets(scene_, {}, {});
  const ImageProblem problem(scene_, targets, parts_, frames_);
  EXPECT_NEAR(brightness->second_view, 90, 1);
}

TEST_F(ShapeFromImages, TakesEveryFrameInOnceForTheDerivativesByAllOfTheShape) {
  const auto counter = std::make_shared<Brightness>();
  parts_.objective = {{.objective = counter}};
  const ShapeTargets targets(scene_, {}, {});
  ImageProblem problem(scene_, targets, parts_, frames_);
  counter->prepared = 0;
  problem.systems(problem.start());
  EXPECT_EQ(counter->prepared, 4);
}

}  // namespace
}  // namespace hypotrack
