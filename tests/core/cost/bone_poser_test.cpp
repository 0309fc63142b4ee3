#include "scene/bone_poser.hpp"

#include <gtest/gtest.h>

#include <random>

#include "every_target.hpp"
#include "hypotrack/plugin/kinematics.hpp"
#include "scene/simd_kernels.hpp"
#include "test_models.hpp"

namespace hypotrack {
namespace {

/// The largest difference of any number of any matrix from those in double precision.
double largest_error(const ModelData& data, const Eigen::VectorXd& state) {
  const std::span<const double> parameters(state.data(), static_cast<std::size_t>(state.size()));
  Eigen::Isometry3d camera_from_world(Eigen::Translation3d(0.1, -0.2, 0.05));
  camera_from_world.rotate(Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized()));
  const BonePoser poser(data);
  BonePoser::Workspace workspace;
  std::vector<float> found(12 * static_cast<std::size_t>(poser.bones()));
  poser.pose(parameters, camera_from_world, workspace, found.data());
  const auto bones = world_from_bones(data, parameters), bind = bind_transforms(data);
  double largest = 0;
  for (std::size_t b = 0; b < bones.size(); ++b) {
    const Eigen::Map<const Eigen::Matrix<float, 3, 4, Eigen::RowMajor>> matrix(found.data() +
                                                                               12 * b);
    const Eigen::Isometry3d expected = camera_from_world * bones[b] * bind[b].inverse();
    largest = std::max(
        largest, (matrix.cast<double>() - expected.matrix().topRows<3>()).cwiseAbs().maxCoeff());
  }
  return largest;
}

TEST(BonePoser, PosesAsKinematicsDoInSinglePrecisionOnEveryInstructionSet) {
  for (const ModelData& data : {test::make_test_hand(), test::make_test_cabinet()}) {
    const Scene scene({{"it", std::make_shared<Model>(data)}});
    test::on_every_target(compiled_simd_targets(), [&] {
      std::mt19937_64 random(4);
      for (int i = 0; i < 50; ++i) {
        EXPECT_LT(largest_error(data, test::random_state(scene, random)), 1e-6);
      }
    });
  }
}

TEST(BonePoser, TurnsByAnyAngle) {
  const ModelData data = test::make_test_hand();
  const Scene scene({{"hand", std::make_shared<Model>(data)}});
  Eigen::VectorXd state = scene.rest_state();
  for (double angle = -30; angle < 30; angle += 0.01) {
    state[7 + 5] = angle;
    EXPECT_LT(largest_error(data, state), 3e-6) << angle;  // an angle of 30 is rounded by 1e-6
  }
}

}  // namespace
}  // namespace hypotrack
