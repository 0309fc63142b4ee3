#include "lab/landscape/landscape.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "lab/landscape/landscape_files.hpp"
#include "test_models.hpp"
#include "test_paths.hpp"

namespace hypotrack {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

struct LandscapeTest : testing::Test {
  Scene scene{{{"box", std::make_shared<Model>(test::make_test_box())}}};
  Eigen::VectorXd state = scene.rest_state();
  LandscapeSettings settings;

  /// Twice the distance of x in millimetres from the centre, and the square of that of y.
  Eigen::MatrixXd costs(const Eigen::MatrixXd& states) const {
    Eigen::MatrixXd out(states.cols(), 2);
    out.col(0) = 2000 * (states.row(0).transpose().array() - state[0]).abs();
    out.col(1) = (1000 * (states.row(1).transpose().array() - state[1])).square();
    return out;
  }
  Landscape measured() const {
    return measure_landscape(
        scene, state, {"near", "level"}, [this](const auto& states) { return costs(states); },
        settings);
  }
};

TEST_F(LandscapeTest, ALineHasTheCostsOfEveryTermAndTheirSum) {
  settings.points = 5;  // -30, -15, 0, 15 and 30 mm
  const Landscape found = measured();
  EXPECT_THAT(found.curves, ElementsAre("sum", "near", "level"));
  EXPECT_EQ(found.centre, Eigen::Vector3d::Zero());
  ASSERT_THAT(found.lines, SizeIs(6));
  EXPECT_EQ(found.axes[0].name, "box.position_x");
  EXPECT_EQ(found.axes[3].name, "box.turn_x");
  EXPECT_EQ(found.axes[3].unit, "deg");
  EXPECT_TRUE(found.lines[0].costs.col(0).isApprox(
      (Eigen::VectorXd(5) << 60, 30, 0, 30, 60).finished(), 1e-9));
  EXPECT_TRUE(found.lines[1].costs.col(2).isApprox(
      (Eigen::VectorXd(5) << 900, 225, 0, 225, 900).finished(), 1e-9));
  EXPECT_TRUE(found.lines[5].costs.isZero(1e-9));  // no term sees a turn
}

TEST_F(LandscapeTest, APairHasTheFirstParameterAlongItsRows) {
  settings.grid = 3;
  const Landscape found = measured();
  ASSERT_THAT(found.pairs, SizeIs(15));
  const LandscapeSlice& xy = found.pairs[0];
  EXPECT_EQ(xy.x, 0U);
  EXPECT_EQ(xy.y, 1U);
  ASSERT_EQ(xy.costs.rows(), 9);
  EXPECT_NEAR(xy.costs(0, 0), 960, 1e-6);  // both at -30 mm
  EXPECT_NEAR(xy.costs(1, 0), 900, 1e-6);  // x at the centre
  EXPECT_NEAR(xy.costs(3, 0), 60, 1e-6);   // y at the centre
}

TEST_F(LandscapeTest, JointsThatSlideAreSlicedInMillimetres) {
  scene = Scene({{"cabinet", std::make_shared<Model>(test::make_test_cabinet())}});
  state = scene.rest_state();
  settings.points = 5;
  settings.grid = 3;
  settings.position = 0.02;
  const Landscape found = measured();
  const auto drawer = std::ranges::find(found.axes, "cabinet.drawer", &LandscapeAxis::name);
  ASSERT_NE(drawer, found.axes.end());
  EXPECT_EQ(drawer->unit, "mm");
  EXPECT_EQ(drawer->to_unit, 1000);
  EXPECT_LE(drawer->offsets.cwiseAbs().maxCoeff(), 0.02);
}

TEST_F(LandscapeTest, SlicesEndAtTheBoundsOfAngles) {
  scene = Scene({{"hand", std::make_shared<Model>(test::make_test_hand())}});
  state = scene.rest_state();
  const Parameter& first = scene.parameters()[7];
  state[7] = first.upper;
  settings.points = settings.grid = 3;
  const Landscape found = measured();
  EXPECT_EQ(found.axes[6].name, first.name);
  EXPECT_EQ(found.axes[6].offsets[2], 0);
  EXPECT_LT(found.axes[6].offsets[0], 0);
}

TEST_F(LandscapeTest, PairsAreOfOnePoseOrLimbUnlessAllAreWanted) {
  scene = Scene({{"hand", std::make_shared<Model>(test::make_test_hand())}});
  state = scene.rest_state();
  settings.points = settings.grid = 3;
  EXPECT_THAT(measured().pairs, SizeIs(15 + 5 * 6));  // a pose of six, five fingers of four
  settings.all_pairs = true;
  EXPECT_THAT(measured().pairs, SizeIs(26 * 25 / 2));
}

TEST_F(LandscapeTest, OnlyModelsThatMoveAreSliced) {
  scene = Scene({{"box", std::make_shared<Model>(test::make_test_box())},
                 {"hand", std::make_shared<Model>(test::make_test_hand())}});
  state = scene.rest_state();
  settings.models = {false, true};
  settings.points = settings.grid = 3;
  const Landscape found = measured();
  ASSERT_THAT(found.lines, SizeIs(26));
  EXPECT_EQ(found.axes[0].name, "hand.position_x");
}

TEST_F(LandscapeTest, TablesHaveARowPerPoint) {
  settings.points = settings.grid = 3;
  EXPECT_THAT(slices_csv(measured()),
              AllOf(testing::StartsWith("parameter,unit,offset,sum,near,level\n"
                                        "box.position_x,mm,-30,60,60,0\nbox.position_x,mm,0,0,0,0"),
                    HasSubstr("\nbox.turn_z,deg,30,")));
  EXPECT_THAT(pairs_csv(measured()),
              HasSubstr("\nbox.position_x,mm,-30,box.position_y,mm,-30,960,60,900\n"));
}

TEST_F(LandscapeTest, InfeasiblePointsAreLeftOut) {
  settings.points = settings.grid = 3;
  const Landscape found = measure_landscape(
      scene, state, {"never"},
      [](const Eigen::MatrixXd& states) -> Eigen::MatrixXd {
        return Eigen::MatrixXd::Constant(states.cols(), 1, std::numeric_limits<double>::infinity());
      },
      settings);
  EXPECT_THAT(slices_csv(found), HasSubstr("box.position_x,mm,-30,,\n"));
  const std::string svg = landscape_svg(found, 0, "nothing");
  EXPECT_THAT(svg, AllOf(HasSubstr("infeasible"), testing::Not(HasSubstr("inf<")),
                         testing::Not(HasSubstr("nan"))));
}

TEST_F(LandscapeTest, OfEqualCostsTheNearestToTheCentreIsMarked) {
  settings.points = 5;
  settings.grid = 3;
  const std::string svg = landscape_svg(measured(), 1, "near");
  // `near` does not see y: its panel, the second from the left, has its dot at the dashed line.
  const std::size_t panel = svg.find("box.position_y");
  const auto number_after = [&](const std::string& key) {
    const std::size_t at = svg.find(key, panel);
    return std::stod(svg.substr(at + key.size()));
  };
  EXPECT_EQ(number_after("<circle cx=\""), number_after("<line x1=\""));
}

TEST_F(LandscapeTest, EveryTermHasAFigureBesideTheSum) {
  const test::TemporaryDirectory folder;
  settings.points = settings.grid = 3;
  write_landscape(measured(), "A box", folder.path() / "out");
  for (const char* name : {"sum.svg", "near.svg", "level.svg", "slices.csv", "pairs.csv"})
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "out" / name)) << name;
}

}  // namespace
}  // namespace hypotrack
