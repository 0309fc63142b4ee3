#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "hypotrack/api/config.hpp"
#include "hypotrack/api/export.hpp"
#include "hypotrack/plugin/model.hpp"
#include "hypotrack/plugin/params.hpp"

namespace hypotrack {

/// The parameters by which a scene sets a model's shape. A model plugin visits them in its own
/// `visit` (`shape.visit(v)`), so that their keys appear among its own.
struct ShapeSettings {
  ConfigNode shape;
  std::filesystem::path shape_file;

  bool given() const { return shape.defined() || !shape_file.empty(); }

  void visit(ParamVisitor& v) {
    v("shape", shape,
      {.help = "map of shape parameters to numbers, for an individual; others are as in "
               "shape_file, or neutral"});
    v("shape_file", shape_file,
      {.help = "YAML file with such a map, as `hypotrack fit-shape` writes it"});
  }
};

/// Returns the values of `parameters`, in their order: from `shape`, else from `shape_file`, else
/// neutral. Throws ConfigError on unknown names and values out of bounds.
HYPOTRACK_API std::vector<double> read_shape(const ShapeSettings& settings,
                                             std::span<const ShapeParameter> parameters);

/// Writes a YAML map for read_shape(): one line per parameter, values rounded to 1/10000.
HYPOTRACK_API std::string shape_yaml(std::span<const ShapeParameter> parameters);

/// Returns the correlations of shape parameters among individuals (PxP). Throws DataError if one
/// has the wrong number of them, or no distribution has such correlations.
HYPOTRACK_API Eigen::MatrixXd shape_correlations(std::span<const ShapeParameter> parameters);

/// Stretch of a bone in its own frame, together with its vertices and children.
struct BoneStretch {
  Eigen::Vector3d factors = Eigen::Vector3d::Ones();
  /// If true, y is stretched only beyond the joint (y > 0); what lies behind it belongs to the
  /// parent.
  bool beyond_joint = false;

  Eigen::Vector3d operator()(const Eigen::Vector3d& p) const {
    const double along = beyond_joint && p.y() < 0 ? 1 : factors.y();
    return {factors.x() * p.x(), along * p.y(), factors.z() * p.z()};
  }
};

/// Stretches the bones of a model; `stretches` has one entry per bone. Vertices move by their
/// skinning weights; landmarks and child joints move with their bone. Throws Error on another
/// number of entries.
HYPOTRACK_API void stretch_bones(ModelData& data, std::span<const BoneStretch> stretches);

/// Scales a model about its origin by `factor`.
HYPOTRACK_API void scale_model(ModelData& data, double factor);

}  // namespace hypotrack
