#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/kinematics.hpp"
#include "hypotrack/plugin/model.hpp"
#include "hypotrack/plugin/shape.hpp"
#include "scene/mesh_topology.hpp"
#include "scene/scene_plan.hpp"

namespace hypotrack {
namespace {

constexpr float kRadius = 0.05F;  // metres

/// A closed ball with poles on the z axis.
ModelData ball(int rings = 60, int sides = 100) {
  Mesh mesh;
  mesh.vertices.resize(3, (rings - 1) * sides + 2);
  const auto at = [&](int ring, int side) { return 1 + (ring - 1) * sides + side % sides; };
  const int last = static_cast<int>(mesh.vertices.cols()) - 1;
  mesh.vertices.col(0) << 0, 0, kRadius;
  mesh.vertices.col(last) << 0, 0, -kRadius;
  std::vector<Eigen::Vector3i> triangles;
  for (int ring = 1; ring < rings; ++ring)
    for (int side = 0; side < sides; ++side) {
      const float a =
          std::numbers::pi_v<float> * static_cast<float>(ring) / static_cast<float>(rings);
      const float b =
          2 * std::numbers::pi_v<float> * static_cast<float>(side) / static_cast<float>(sides);
      mesh.vertices.col(at(ring, side)) << kRadius * std::sin(a) * std::cos(b),
          kRadius * std::sin(a) * std::sin(b), kRadius * std::cos(a);
      if (ring == 1) triangles.push_back({0, at(1, side), at(1, side + 1)});
      if (ring + 1 == rings) {
        triangles.push_back({last, at(ring, side + 1), at(ring, side)});
      } else {
        triangles.push_back({at(ring, side), at(ring + 1, side), at(ring + 1, side + 1)});
        triangles.push_back({at(ring, side), at(ring + 1, side + 1), at(ring, side + 1)});
      }
    }
  mesh.triangles.resize(3, static_cast<Eigen::Index>(triangles.size()));
  for (std::size_t t = 0; t < triangles.size(); ++t)
    mesh.triangles.col(static_cast<Eigen::Index>(t)) = triangles[t];
  return rigid_model(std::move(mesh));
}

/// The smallest distance of a triangle's middle from the centre of a ball.
float nearest_middle(const Mesh& mesh) {
  float nearest = 2 * kRadius;
  for (const auto& t : mesh.triangles.colwise())
    nearest = std::min(nearest, mesh.vertices(Eigen::all, t).rowwise().mean().norm());
  return nearest;
}

TEST(Simplify, MakesFewTrianglesNearTheSurface) {
  ModelData data = ball();
  const double error = simplify(data, 0.5e-3);
  EXPECT_GT(error, 0);
  EXPECT_LE(error, 0.5e-3);
  EXPECT_LT(data.simplified.triangles.cols() * 4, data.mesh.triangles.cols());
  EXPECT_TRUE(internal::is_closed_outwards(data.simplified));
  EXPECT_GT(nearest_middle(data.simplified), kRadius - 0.6e-3F);
  EXPECT_EQ(data.mesh.vertices, ball().mesh.vertices);
  validate(data, "ball");
}

TEST(Simplify, LeavesASurfaceWithoutSpareTrianglesAsItIs) {
  ModelData data = ball(8, 12);
  EXPECT_EQ(simplify(data, 0.05e-3), 0);
  EXPECT_EQ(data.simplified.triangles.cols(), 0);
  data = ball();
  EXPECT_EQ(simplify(data, 0), 0);
  EXPECT_EQ(data.simplified.triangles.cols(), 0);
}

TEST(Simplify, IsScaledAndMirroredWithTheModel) {
  ModelData data = ball();
  simplify(data, 0.5e-3);
  ModelData scaled = data;
  scale_model(scaled, 2);
  EXPECT_TRUE(scaled.simplified.vertices.isApprox(2 * data.simplified.vertices));
  const ModelData other = mirrored(data);
  EXPECT_TRUE(internal::is_closed_outwards(other.simplified));
  EXPECT_EQ(other.simplified.vertices.row(0), -data.simplified.vertices.row(0));
}

TEST(Simplify, MakesWhatHypothesesAreScoredWith) {
  ModelData data = ball();
  simplify(data, 0.5e-3);
  const Scene scene({{"ball", std::make_shared<const Model>(data)}});
  const internal::ScenePlan whole(scene);
  const internal::ScenePlan simplified(scene, internal::ScenePlan::Surface::simplified);
  EXPECT_LT(simplified.triangle_count * 4, whole.triangle_count);
  EXPECT_LT(simplified.vertex_count * 4, whole.vertex_count);
}

TEST(Simplify, ItsSurfaceIsValidatedToo) {
  ModelData data = ball();
  simplify(data, 0.5e-3);
  data.simplified.triangles(0, 0) = static_cast<int>(data.simplified.vertices.cols());
  EXPECT_THROW(validate(data, "ball"), DataError);
}

}  // namespace
}  // namespace hypotrack
