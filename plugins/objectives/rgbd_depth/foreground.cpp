#include "foreground.hpp"

#include <algorithm>
#include <limits>
#include <vector>

#include "hypotrack/plugin/kinematics.hpp"

namespace hypotrack::rgbd_depth {
namespace {

/// Computes the z of every vertex in a camera. Skins only z, as this runs once per frame.
Eigen::VectorXf skinned_depths(const ModelData& data, std::span<const double> parameters,
                               const Eigen::Isometry3d& camera_from_world) {
  const std::vector<Eigen::Isometry3d> bones = world_from_bones(data, parameters);
  const std::vector<Eigen::Isometry3d> bind = bind_transforms(data);
  std::vector<Eigen::Vector4f> z_of_bone(bones.size());
  for (std::size_t i = 0; i < bones.size(); ++i) {
    const Eigen::Isometry3d camera_from_model = camera_from_world * bones[i] * bind[i].inverse();
    z_of_bone[i] = camera_from_model.matrix().row(2).transpose().cast<float>();
  }
  const Mesh& mesh = data.mesh;
  Eigen::VectorXf depths(mesh.vertices.cols());
  for (Eigen::Index v = 0; v < depths.size(); ++v) {
    Eigen::Vector4f z = Eigen::Vector4f::Zero();
    for (int k = 0; k < 4; ++k) {
      z += mesh.bone_weights(k, v) * z_of_bone[static_cast<std::size_t>(mesh.bone_indices(k, v))];
    }
    depths[v] = z.head<3>().dot(mesh.vertices.col(v)) + z[3];
  }
  return depths;
}

Eigen::VectorXf depths_of(const Model& model, std::span<const double> parameters,
                          const Eigen::Isometry3d& camera_from_world) {
  if (!model.poses_itself()) return skinned_depths(model.data(), parameters, camera_from_world);
  const Eigen::Isometry3f camera = camera_from_world.cast<float>();
  return (camera.linear().row(2) * posed_vertices(model, parameters)).array() +
         camera.translation().z();
}

/// A row of the images that a rule uses; null for the others.
struct ViewRow {
  const std::uint8_t* valid;
  const std::uint8_t* mask;
  const float* depth;
  const std::uint8_t* color;

  ViewRow(const TileView& view, Rule rule, int y)
      : valid(view.valid.ptr(y)),
        mask(rule == Rule::mask ? view.mask.ptr(y) : nullptr),
        depth(view.depth.ptr<float>(y)),
        color(rule == Rule::skin ? view.color.ptr(y) : nullptr) {}

  ViewedPixel at(int x) const {
    ViewedPixel pixel{valid[x] != 0, mask && mask[x] != 0, depth[x], 0, 0, 0};
    if (!color) return pixel;
    const std::uint8_t* bgr = color + 3 * x;
    pixel.blue = bgr[0];
    pixel.green = bgr[1];
    pixel.red = bgr[2];
    return pixel;
  }
};

}  // namespace

DepthRange depth_range(const Scene& scene, const Eigen::VectorXd& state, const TileCamera& camera,
                       double margin) {
  double nearest = std::numeric_limits<double>::infinity(), farthest = 0;
  for (const Scene::Item& item : scene.items()) {
    const Eigen::VectorXf z =
        depths_of(*item.model, scene.part(item, state), camera.camera_from_world);
    nearest = std::min(nearest, double{z.minCoeff()} - margin);
    farthest = std::max(farthest, double{z.maxCoeff()} + margin);
  }
  return {static_cast<float>(nearest), static_cast<float>(farthest)};
}

ObservedView observe(const TileView& view, Foreground foreground, const DepthRange& range) {
  const Rule rule = rule_of(foreground, !view.mask.empty());
  ObservedView out;
  out.pixels.resize(view.depth.cols, view.depth.rows);
  for (int y = 0; y < view.depth.rows; ++y) {
    const ViewRow row(view, rule, y);
    float* observed = out.pixels.row(y);
    for (int x = 0; x < view.depth.cols; ++x) {
      observed[x] = observed_at(row.at(x), rule, range);
      out.measured += observed[x] > 0.0f;
      out.foreground += observed[x] > 0.0f || observed[x] == kUnmeasured;
    }
  }
  return out;
}

}  // namespace hypotrack::rgbd_depth
