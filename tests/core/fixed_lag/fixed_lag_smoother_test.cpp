#include "track/smooth/fixed_lag_smoother.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <random>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "test_models.hpp"
#include "track/tangent.hpp"

namespace hypotrack {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr double kUnseen = std::numeric_limits<double>::quiet_NaN();
constexpr double kRate = 30;

/// Readings of a box: in every frame of its x and of its turn about z, both where they are seen.
class Readings final : public Objective, public ResidualTerm {
 public:
  struct Reading {
    double x = kUnseen, turn = kUnseen;
  };
  explicit Readings(std::vector<Reading> frames, bool draws = false)
      : frames_(std::move(frames)), draws_(draws) {}
  bool no_motion_prior() const { return no_motion_prior_; }

 private:
  bool do_needs_rendering() const override { return draws_; }
  void do_prepare(const Observation& seen) override {
    now_ = frames_[static_cast<std::size_t>(seen.frame)];
    no_motion_prior_ = seen.context.no_motion_prior;
  }
  double do_cost(const RenderedHypothesis& h) const override {
    double sum = 0;
    for (const double r : of(h)) sum += r * r;
    return sum;
  }
  const ResidualTerm* do_residual_term() const override { return this; }
  std::int64_t do_residual_count() const override { return 2; }
  void do_write_residuals(const RenderedHypothesis& h, std::span<float> residuals) const override {
    for (std::size_t i = 0; i < 2; ++i) residuals[i] = static_cast<float>(of(h)[i]);
  }

  /// In units of a millimetre and of a mrad.
  std::array<double, 2> of(const RenderedHypothesis& h) const {
    const Eigen::Quaterniond q(h.state[3], h.state[4], h.state[5], h.state[6]);
    const Eigen::Quaterniond seen(Eigen::AngleAxisd(now_.turn, Eigen::Vector3d::UnitZ()));
    return {std::isnan(now_.x) ? 0 : 1e3 * (h.state[0] - now_.x),
            std::isnan(now_.turn) ? 0 : 1e3 * rotation_log(seen.conjugate() * q).z()};
  }
  std::vector<Reading> frames_;
  bool draws_;
  bool no_motion_prior_ = false;
  Reading now_;
};

struct SmoothedBox {
  Scene scene{{{"box", std::make_shared<Model>(test::make_test_box())}}};
  FixedLagSettings settings{.prior = 1};  // readings are of the pose only
  EvaluateSettings evaluate{.backend = Backend::cpu, .threads = 1};

  Eigen::VectorXd state(double x, double turn = 0) const {
    Eigen::VectorXd off = Eigen::VectorXd::Zero(6);
    off[0] = x;
    off[5] = turn;
    return moved(scene, scene.rest_state(), off);
  }

  /// Found states with what was read, and what the smoother makes of them.
  std::vector<FixedLagSmoother::Settled> revised(const std::vector<Readings::Reading>& read,
                                                 const std::vector<Eigen::VectorXd>& found,
                                                 const std::vector<bool>& lost = {},
                                                 bool draws = false,
                                                 std::size_t* most_waiting = nullptr) const {
    FixedLagSmoother smoother(scene, {{1.0, std::make_shared<Readings>(read, draws)}}, evaluate,
                              settings);
    std::vector<FixedLagSmoother::Settled> all;
    for (std::size_t i = 0; i < found.size(); ++i) {
      Observation seen;
      seen.frame = static_cast<int>(i);
      const bool blind = !lost.empty() && lost[i];
      smoother.add(blind ? FrameTiles() : FrameTiles(seen),
                   {static_cast<double>(i) / kRate, found[i]});
      for (FixedLagSmoother::Settled& one : smoother.take()) all.push_back(std::move(one));
      if (most_waiting) *most_waiting = std::max(*most_waiting, i + 1 - all.size());
    }
    for (FixedLagSmoother::Settled& one : smoother.finish()) all.push_back(std::move(one));
    return all;
  }
};

/// A box that moves and turns evenly, read in all frames but 10 to 19, through which the tracker
/// left it where it was.
struct Hidden {
  explicit Hidden(const SmoothedBox& f) {
    for (int i = 0; i < 30; ++i) {
      const bool hidden = i >= 10 && i < 20;
      const double x = 0.01 * i, turn = 0.15 * i;
      truth.push_back(f.state(x, turn));
      read.push_back(hidden ? Readings::Reading{} : Readings::Reading{x, turn});
      found.push_back(hidden ? truth[9] : truth.back());
    }
  }
  std::vector<Eigen::VectorXd> truth, found;
  std::vector<Readings::Reading> read;
};

TEST(FixedLagSmoother, ANumberThatNoFrameBetweenSeesIsInterpolated) {
  const SmoothedBox f;
  const Hidden hidden(f);
  const auto revised = f.revised(hidden.read, hidden.found);
  ASSERT_EQ(revised.size(), 30u);
  ASSERT_NEAR(difference(f.scene, hidden.truth[19], hidden.found[19])[0], -0.1, 1e-9);
  for (std::size_t i = 0; i < revised.size(); ++i) {
    const Eigen::VectorXd off = difference(f.scene, hidden.truth[i], revised[i].state);
    EXPECT_NEAR(off[0], 0, 0.0005) << "frame " << i;
    EXPECT_NEAR(off[5], 0, 0.005) << "a rotation, along the shortest turn; frame " << i;
    EXPECT_NEAR(revised[i].state.segment<4>(3).norm(), 1, 1e-9);
  }
}

TEST(FixedLagSmoother, ANumberThatEveryFrameSeesStays) {
  SmoothedBox f;
  f.settings.position_change = 50;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> jitter(-0.01, 0.01);
  std::vector<Readings::Reading> read;
  std::vector<Eigen::VectorXd> found;
  for (int i = 0; i < 30; ++i) {
    read.push_back({.x = jitter(random), .turn = 0});
    found.push_back(f.state(read.back().x));
  }
  const auto revised = f.revised(read, found);
  for (std::size_t i = 0; i < revised.size(); ++i)
    EXPECT_NEAR(revised[i].state[0], read[i].x, 0.0002) << "frame " << i;
}

TEST(FixedLagSmoother, AFrameInWhichTheSceneWasLostTellsNothing) {
  const SmoothedBox f;
  Hidden hidden(f);
  std::vector<bool> lost(30, false);
  for (std::size_t i = 12; i < 16; ++i) {
    lost[i] = true;
    hidden.read[i] = {.x = 5, .turn = 1};  // of something else
    hidden.found[i] = f.state(5, 1);
  }
  const auto revised = f.revised(hidden.read, hidden.found, lost);
  for (std::size_t i = 0; i < revised.size(); ++i)
    EXPECT_NEAR(revised[i].state[0], hidden.truth[i][0], 0.0005) << "frame " << i;
  EXPECT_EQ(revised[13].evaluations, 0);
  EXPECT_GT(revised[20].evaluations, 0);
}

TEST(FixedLagSmoother, TellsTermsOfItself) {
  const SmoothedBox f;
  const auto readings = std::make_shared<Readings>(std::vector<Readings::Reading>(3, {0, 0}));
  FixedLagSmoother smoother(f.scene, {{1.0, readings}}, f.evaluate, f.settings);
  for (int i = 0; i < 3; ++i) {
    Observation seen;
    seen.frame = i;
    smoother.add(seen, {i / kRate, f.state(0)});
  }
  smoother.finish();
  EXPECT_TRUE(readings->no_motion_prior());
}

TEST(FixedLagSmoother, WorksByDifferencesWhereTermsHaveNoSlopes) {
  SmoothedBox f;
  f.settings.evaluations = 200;
  const Hidden hidden(f);
  const auto revised = f.revised(hidden.read, hidden.found, {}, true);
  for (std::size_t i = 0; i < revised.size(); ++i)
    EXPECT_NEAR(revised[i].state[0], hidden.truth[i][0], 0.0005) << "frame " << i;
}

TEST(FixedLagSmoother, EqualRunsAreEqual) {
  const SmoothedBox f;
  const Hidden hidden(f);
  const auto first = f.revised(hidden.read, hidden.found);
  const auto second = f.revised(hidden.read, hidden.found);
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(first[i].state, second[i].state) << i;
}

TEST(FixedLagSmoother, NeverTakesMoreEvaluationsThanItMayAndSaysHowMany) {
  SmoothedBox f;
  const Hidden hidden(f);
  for (const double window : {20.0, 0.4}) {
    f.settings.window = window;
    f.settings.lag = 0.2;
    f.settings.evaluations = 12;
    for (const auto& one : f.revised(hidden.read, hidden.found)) {
      EXPECT_LE(one.evaluations, 12);
      EXPECT_GE(one.evaluations, 4) << "two linearisations";
    }
  }
}

TEST(FixedLagSmoother, WindowsSettleEveryFrameOnceAndHoldNoMoreThanTheirTime) {
  SmoothedBox f;
  f.settings.window = 1;
  f.settings.lag = 0.5;
  std::vector<Readings::Reading> read;
  std::vector<Eigen::VectorXd> found;
  for (int i = 0; i < 150; ++i) {
    const bool hidden = i % 50 > 40;
    read.push_back(hidden ? Readings::Reading{.turn = 0} : Readings::Reading{0.01 * i, 0});
    found.push_back(f.state(hidden ? 0.4 : 0.01 * i));
  }
  std::size_t most_waiting = 0;
  const auto revised = f.revised(read, found, {}, false, &most_waiting);
  ASSERT_EQ(revised.size(), 150u);
  EXPECT_LE(most_waiting, 31u);
  for (std::size_t i = 0; i < 140; ++i)  // what comes behind the last is unknown
    EXPECT_NEAR(revised[i].state[0], 0.01 * static_cast<double>(i), 0.002) << "frame " << i;
}

TEST(FixedLagSmoother, OfNoFrameOrOneIsWhatWasFound) {
  const SmoothedBox f;
  EXPECT_TRUE(f.revised({}, {}).empty());
  const auto one = f.revised({{0.1, 0}}, {f.state(0.1)});
  ASSERT_EQ(one.size(), 1u);
  EXPECT_NEAR(one[0].state[0], 0.1, 1e-6);
}

TEST(FixedLagSmoother, RefusesSettingsThatDoNotFit) {
  SmoothedBox f;
  f.settings.lag = 15;
  EXPECT_THAT(test::message_of<ConfigError>([&] { f.revised({}, {}); }),
              AllOf(HasSubstr("smoothing.fixed_lag.lag_s is 15"),
                    HasSubstr("smoothing.fixed_lag.window_s"), HasSubstr("expected 10 at most")));
  f.settings.lag = 2;
  f.settings.evaluations = 7;
  EXPECT_THAT(
      test::message_of<ConfigError>([&] { f.revised({}, {}); }),
      AllOf(HasSubstr("smoothing.fixed_lag.evaluations is 7"), HasSubstr("expected 8 or more")));
}

/// A cost without residuals.
class NoSquares final : public Objective {
 public:
 private:
  void do_prepare(const Observation&) override {}
  double do_cost(const RenderedHypothesis&) const override { return 0; }
};

TEST(FixedLagSmoother, RefusesATermWithoutResidualsByItsName) {
  const SmoothedBox f;
  const auto open = [&] {
    FixedLagSmoother(f.scene, {{1.0, std::make_shared<NoSquares>(), "smell"}}, f.evaluate,
                     f.settings);
  };
  EXPECT_THAT(test::message_of<ConfigError>(open),
              AllOf(HasSubstr("fixed-lag smoothing needs residuals"), HasSubstr("objective smell"),
                    HasSubstr("offers no residuals")));
}

}  // namespace
}  // namespace hypotrack
