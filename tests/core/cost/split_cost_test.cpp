// Terms on a GPU and terms of the state on the CPU in one cost. Here both are on the CPU.
#include "cost/split_cost.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <opencv2/core.hpp>

#include "cost/backends.hpp"
#include "cost/cost.hpp"
#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/gpu/device_objective.hpp"
#include "linearized_terms.hpp"
#include "observations.hpp"
#include "test_models.hpp"
#include "tile/tiles.hpp"

namespace hypotrack::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A GPU part that is never called.
class OnDevice final : public cuda::DeviceObjective {
 public:
  explicit OnDevice(bool residuals) : residuals_(residuals) {}
  void prepare(const cuda::DeviceObservation&, cuda::Stream) override {}
  void reserve(const cuda::SceneLayout&, const cuda::DeviceLimits&, std::int64_t) override {}
  void enqueue(const cuda::SceneLayout&, const cuda::BatchLayout&, cuda::Stream) override {}
  void enqueue_drawn(const cuda::SceneLayout&, const cuda::BatchLayout&, const cuda::DrawnBatch&,
                     cuda::Stream) override {}
  bool has_residuals() const override { return residuals_; }
  std::uint64_t revision() const override { return 0; }

 private:
  bool residuals_;
};

/// The position, with a part for a GPU.
class PositionOnDevice final : public Position {
 public:
  explicit PositionOnDevice(bool residuals) : residuals_(residuals) {}

 private:
  std::unique_ptr<cuda::DeviceObjective> do_on_device() const override {
    return std::make_unique<OnDevice>(residuals_);
  }

  bool residuals_;
};

/// The position, with `beyond` for its cost where x is above a fence.
class FencedPosition final : public Position {
 public:
  FencedPosition(double fence, double beyond) : fence_(fence), beyond_(beyond) {}

 private:
  double do_cost(const RenderedHypothesis& h) const override {
    return h.state[0] > fence_ ? beyond_ : Position::do_cost(h);
  }

  double fence_, beyond_;
};

/// Remembers whether it was prepared with images.
class Watching final : public Position {
 public:
  explicit Watching(bool color) : color_(color) {}
  bool images = false;

 private:
  ImageUse do_image_use() const override {
    return {.color = color_, .mask = false, .depth = false};
  }
  void do_prepare(const Observation& observation) override {
    images = !observation.views[0].color.empty();
  }

  bool color_;
};

class SplitCostTest : public testing::Test {
 protected:
  std::unique_ptr<Cost> host(const std::vector<ObjectiveTerm>& terms) const {
    return make_host_cost(scene_, terms, {.backend = Backend::cpu, .threads = 1});
  }
  std::unique_ptr<Cost> split(const SplitTerms& terms) const {
    auto cost = make_split_cost(scene_, terms, host(terms.gpu), host(terms.cpu), "both");
    cost->prepare(frame_);
    return cost;
  }
  std::unique_ptr<Cost> whole(const SplitTerms& terms) const {
    std::vector<ObjectiveTerm> all = terms.gpu;
    all.insert(all.end(), terms.cpu.begin(), terms.cpu.end());
    auto cost = host(all);
    cost->prepare(frame_);
    return cost;
  }

  Scene scene_ = hand_scene();
  Observation frame_ = rectified_pair(scene_);
  Eigen::VectorXd steps_ = metres_and_radians(scene_.dimension() - 1, 1e-3, 5e-3);
  Eigen::MatrixXd states_ = moved_states(scene_, hand_state(scene_), steps_);
  std::shared_ptr<DepthPattern> drawn_ = std::make_shared<DepthPattern>(0.2f, 0.5f);
  std::shared_ptr<Position> position_ = std::make_shared<Position>();
  SplitTerms terms_{{{2, drawn_, "drawn"}}, {{3, position_, "place"}, {0.5, position_, "again"}}};
};

TEST_F(SplitCostTest, CostsAndResidualsAreThoseOfAllTerms) {
  const auto both = split(terms_), all = whole(terms_);
  Eigen::VectorXd found(states_.cols()), expected = found;
  both->evaluate(states_, found);
  all->evaluate(states_, expected);
  EXPECT_TRUE(found.isApprox(expected, 1e-12));

  StateResiduals &of_both = *both->least_squares(), &of_all = *all->least_squares();
  ASSERT_EQ(of_both.count(), of_all.count());
  Eigen::MatrixXf r(of_all.count(), states_.cols()), s = r;
  of_both.evaluate(states_, r, found);
  of_all.evaluate(states_, s, expected);
  EXPECT_EQ(r, s);
  EXPECT_TRUE(found.isApprox(expected, 1e-12));
}

TEST_F(SplitCostTest, RowsOfTheStateAreNamed) {
  const auto both = split(terms_);
  const std::vector<ResidualRows> rows = both->least_squares()->pose_only();
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].first, both->least_squares()->count() - 6);
  EXPECT_EQ(rows[0].count, 6);
}

TEST_F(SplitCostTest, NormalEquationsAreThoseOfAllTerms) {
  const auto both = split(terms_), all = whole(terms_);
  ASSERT_TRUE(both->least_squares()->can_linearize());
  EXPECT_EQ(both->least_squares()->linearize_price(9), 1);
  const NormalEquations found = both->least_squares()->linearize(states_, steps_, 1);
  const NormalEquations expected = all->least_squares()->linearize(states_, steps_, 1);
  EXPECT_TRUE(found.a.isApprox(expected.a, 1e-9));
  EXPECT_TRUE(found.g.isApprox(expected.g, 1e-9));
}

TEST_F(SplitCostTest, DifferencesAreThoseOfAllTermsAndLeaveInfiniteCostsOut) {
  SplitTerms terms = terms_;
  const double fence = states_(0, 0) + 0.5 * steps_[0];
  terms.cpu.push_back({1, std::make_shared<FencedPosition>(fence, kInfinity), "fence"});
  const auto both = split(terms), all = whole(terms);
  const auto normal = [&](Cost& cost) {
    const auto differences = cost.least_squares()->differences();
    Eigen::VectorXd first(2), costs(steps_.size());
    differences->evaluate(states_.leftCols(2), first);
    EXPECT_EQ(first[1], kInfinity);
    differences->move_to(0);
    const NormalEquations sums = differences->normal_equations(states_.rightCols(steps_.size()),
                                                               steps_.cwiseInverse(), costs);
    EXPECT_EQ(costs[0], kInfinity);
    EXPECT_TRUE(costs.tail(costs.size() - 1).allFinite());
    return sums;
  };
  const NormalEquations found = normal(*both), expected = normal(*all);
  EXPECT_EQ(found.a(0, 0), 0);
  EXPECT_GT(found.a(1, 1), 0);
  EXPECT_TRUE(found.a.isApprox(expected.a, 1e-4));
  EXPECT_TRUE(found.g.isApprox(expected.g, 1e-4));
}

TEST_F(SplitCostTest, InfinitiesThatCancelAreRefused) {
  const double fence = -1;
  const SplitTerms terms{{{1, std::make_shared<FencedPosition>(fence, kInfinity), "wall"}},
                         {{-1, std::make_shared<FencedPosition>(fence, kInfinity), "hole"}}};
  const auto both = split(terms);
  Eigen::VectorXd costs(states_.cols());
  EXPECT_THAT(message_of<Error>([&] { both->evaluate(states_, costs); }),
              testing::HasSubstr("objective hole adds an infinity to its opposite"));
}

TEST_F(SplitCostTest, OnlyTermsThatReadImagesMakeThemOnTheCpu) {
  Camera camera{64, 64, 60, 60, 31.5, 31.5, DistortionModel::none, {}, {}};
  camera.camera_from_world = Eigen::Isometry3d::Identity();
  const TileMaker tiles(scene_, {camera, camera}, {.size = 32});
  Frame frame;
  frame.views.resize(2);
  for (View& view : frame.views) view.color = cv::Mat(64, 64, CV_8UC3, cv::Scalar(1, 2, 3));
  for (const bool color : {true, false}) {
    const auto drawn = std::make_shared<Watching>(true), posed = std::make_shared<Watching>(color);
    const SplitTerms terms{{{1, drawn}}, {{1, posed}}};
    const auto both = make_split_cost(scene_, terms, host(terms.gpu), host(terms.cpu), "both");
    both->prepare(tiles, frame, tiles.plan(frame, hand_state(scene_)));
    EXPECT_TRUE(drawn->images);
    EXPECT_EQ(posed->images, color);
  }
}

TEST_F(SplitCostTest, TermsWithoutRenderingAndGpuPartStayOnTheCpu) {
  const auto full = std::make_shared<PositionOnDevice>(true);
  const auto plain = std::make_shared<PositionOnDevice>(false);
  const std::vector<ObjectiveTerm> terms{
      {1, drawn_, "drawn"}, {1, full, "full"}, {1, plain, "plain"}, {1, position_, "place"}};
  EXPECT_EQ(split_terms(terms, false).cpu_names(), "place");
  EXPECT_EQ(split_terms(terms, false).gpu.size(), 3u);
  EXPECT_EQ(split_terms(terms, true).cpu_names(), "plain, place");
  EXPECT_EQ(split_terms({{1, position_, "place"}}, true).cpu_names(), "") << "nothing is drawn";
  EXPECT_EQ(split_terms({{0, drawn_, "drawn"}, {1, position_, "place"}}, true).gpu.size(), 2u);
}

}  // namespace
}  // namespace hypotrack::test
