#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "hypotrack/config.hpp"
#include "hypotrack/export.hpp"
#include "hypotrack/model.hpp"
#include "hypotrack/params.hpp"

namespace hypotrack {

/// How a scene gives a model its shape. A model plugin visits it from its own parameters' `visit`
/// (`shape.visit(v)`), so that its keys stand beside the others.
struct ShapeSettings {
  ConfigNode shape;
  std::filesystem::path shape_file;

  bool given() const { return shape.defined() || !shape_file.empty(); }

  void visit(ParamVisitor& v) {
    v("shape", shape,
      {.help = "map of shape parameters to numbers: how this individual is built; what is not "
               "named is as in shape_file, or neutral"});
    v("shape_file", shape_file,
      {.help = "YAML file with such a map, as `hypotrack fit-shape` writes it"});
  }
};

/// The values of `parameters`, in their order: those of the file, replaced by those of `shape`, the
/// neutral ones where neither names them. Throws ConfigError on unknown names and values out of
/// bounds.
HYPOTRACK_API std::vector<double> read_shape(const ShapeSettings& settings,
                                             std::span<const ShapeParameter> parameters);

/// The map that read_shape() reads, in YAML: a line for each parameter's value, rounded to
/// 1/10000.
HYPOTRACK_API std::string shape_yaml(std::span<const ShapeParameter> parameters);

/// How a bone is stretched in its own frame, with its flesh and what hangs on it.
struct BoneStretch {
  Eigen::Vector3d factors = Eigen::Vector3d::Ones();
  /// Along y only what lies beyond the joint (y > 0) is: what is behind it belongs to the parent.
  bool beyond_joint = false;

  Eigen::Vector3d operator()(const Eigen::Vector3d& p) const {
    const double along = beyond_joint && p.y() < 0 ? 1 : factors.y();
    return {factors.x() * p.x(), along * p.y(), factors.z() * p.z()};
  }
};

/// Stretches the bones of a model, one entry for each: vertices move by their weights as when the
/// bind pose is skinned, landmarks and the joints of children with their bone. Throws Error on
/// another number of entries.
HYPOTRACK_API void stretch_bones(ModelData& data, std::span<const BoneStretch> stretches);

/// Makes everything about a model larger: `factor` times as far from its origin.
HYPOTRACK_API void scale_model(ModelData& data, double factor);

}  // namespace hypotrack
