#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/shape.hpp"
#include "test_models.hpp"

namespace hypotrack::test {

/// The test hand with a size and a length of its index finger.
class ShapedHand final : public Model {
 public:
  explicit ShapedHand(std::vector<double> values = {1, 1})
      : Model(built(values)), values_(std::move(values)) {}

 private:
  std::vector<ShapeParameter> do_shape_parameters() const override {
    return {{"scale", values_[0], 1, 0.7, 1.35, 0.07},
            {"index", values_[1], 1, 0.75, 1.3, 0.05, {-0.3}}};
  }
  ModelData do_shaped(std::span<const double> values) const override {
    return built({values.begin(), values.end()});
  }

  static ModelData built(const std::vector<double>& values) {
    ModelData data = make_test_hand();
    data.simplified = data.mesh;
    std::vector<BoneStretch> stretches(data.bones.size());
    for (const BoneMotion& r : data.motions) {
      const Parameter& p = data.parameters[static_cast<std::size_t>(r.parameter)];
      if (p.name.starts_with("index_"))
        stretches[static_cast<std::size_t>(r.bone)].factors = {1, values[1], 1};
    }
    stretch_bones(data, stretches);
    scale_model(data, values[0]);
    return data;
  }
  std::vector<double> values_;
};

inline Scene shaped_scene(std::vector<double> values = {1, 1}) {
  return Scene({{"hand", std::make_shared<ShapedHand>(std::move(values))}});
}

}  // namespace hypotrack::test
