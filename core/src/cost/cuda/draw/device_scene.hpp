#pragma once

#include <string>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/gpu/runtime.cuh"
#include "hypotrack/plugin/model.hpp"

namespace hypotrack::cuda {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns why the GPU cannot pose and draw a scene: a model that poses itself, or too many
/// vertices or bones. Empty if it can.
std::string why_not_on_device(const Scene& scene);

/// A scene's models in device memory.
class DeviceScene {
 public:
  /// Uploads the scene and waits. Throws DeviceError with the reason of why_not_on_device(), if
  /// there is one.
  explicit DeviceScene(const Scene& scene);

  const SceneLayout& layout() const { return layout_; }

 private:
  DeviceBuffer<ModelLayout> models_;
  DeviceBuffer<BoneLayout> bones_;
  DeviceBuffer<JointMotion> motions_;
  DeviceBuffer<VertexLayout> vertices_;
  DeviceBuffer<PackedTriangle> triangles_;
  SceneLayout layout_{};
};

/// Returns the triangle indices sorted so that neighbours are close and face the same way. A warp
/// then usually finds all of its triangles visible or none.
std::vector<int> order_by_place(const Mesh& mesh);

}  // namespace internal
}  // namespace hypotrack::cuda
