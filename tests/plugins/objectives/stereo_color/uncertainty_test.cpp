#include "track/uncertainty.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "rendered_pair.hpp"
#include "stereo_color.hpp"

namespace hypotrack::stereo_color {
namespace {

/// The back of the hand to the cameras, the index finger bent behind the palm, the others straight.
Eigen::VectorXd index_hidden(const Scene& scene) {
  Eigen::VectorXd state = scene.rest_state();
  state.head<7>() << -0.005, 0.085, 0.5, 0, 0, 0, 1;  // half a turn about z: fingers up
  for (Eigen::Index i = 7; i < state.size(); ++i) {
    const Parameter& p = scene.parameters()[static_cast<std::size_t>(i)];
    if (p.name.find("index_flexion") != std::string::npos) state[i] = 0.9 * p.upper;
  }
  return state;
}

double sigma_of(const Scene& scene, const Eigen::VectorXd& sigma, const std::string& landmark) {
  const auto& names = scene.landmark_names();
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == "hand." + landmark) return sigma[static_cast<Eigen::Index>(i)];
  ADD_FAILURE() << "no landmark " << landmark;
  return 0;
}

TEST(Uncertainty, OfAHiddenFingerIsLargerThanOfAVisibleOne) {
  Params params;
  params.beta = 50;
  params.distinctiveness = Distinctiveness::none;
  params.lookup = Lookup::bilinear;
  params.direction = Direction::both;
  const RenderedPair pair(index_hidden);
  const auto cost = make_cost(pair.scene(), {{1.0, std::make_shared<StereoColor>(params)}},
                              {.backend = Backend::cpu, .threads = 1}, {.least_squares = true});
  cost->prepare(pair.observation());
  const Eigen::VectorXd sigma = PoseUncertainty(pair.scene(), {}).of(*cost, pair.truth());
  for (const std::string joint : {"_2", "_3", "_tip"}) {
    const double hidden = sigma_of(pair.scene(), sigma, "index" + joint);
    for (const std::string visible : {"middle", "ring", "little"}) {
      EXPECT_GT(hidden, 2 * sigma_of(pair.scene(), sigma, visible + joint)) << visible + joint;
    }
  }
}

}  // namespace
}  // namespace hypotrack::stereo_color
