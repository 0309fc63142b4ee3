#pragma once

#include <string>
#include <vector>

#include "hypotrack/cuda/runtime.cuh"
#include "hypotrack/scene.hpp"

namespace hypotrack::cuda {

/// Why a scene cannot be posed and drawn on the GPU: a model that poses itself, too many vertices
/// or bones. Empty if it can.
std::string why_not_on_device(const Scene& scene);

/// A scene's models in device memory.
class DeviceScene {
 public:
  /// Uploads; returns when it is done. Throws DeviceError where why_not_on_device() has a reason.
  explicit DeviceScene(const Scene& scene);

  const SceneLayout& layout() const { return layout_; }

 private:
  DeviceBuffer<ModelLayout> models_;
  DeviceBuffer<BoneLayout> bones_;
  DeviceBuffer<Turn> turns_;
  DeviceBuffer<VertexLayout> vertices_;
  DeviceBuffer<PackedTriangle> triangles_;
  SceneLayout layout_{};
};

}  // namespace hypotrack::cuda
