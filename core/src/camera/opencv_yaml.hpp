#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "hypotrack/config.hpp"

namespace hypotrack {

/// Reads the YAML that cv::FileStorage writes. Not with cv::FileStorage: it crashes on damaged
/// files and does not say where the damage is. Throws DataError on XML, JSON and compressed files,
/// files over 8 MiB and broken YAML.
ConfigNode read_opencv_yaml(const std::filesystem::path& file);

/// A matrix as it is written: `!!opencv-matrix` with rows, cols, dt and data, a plain list of
/// numbers (one row), or a list of rows.
struct YamlMatrix {
  int rows = 0;
  int cols = 0;
  std::vector<double> values;  ///< row by row, finite
  std::string where;           ///< `extrinsics.yml:3:4: R`
};

/// Throws DataError, naming file, line and `name`, unless the node is a matrix of finite numbers
/// with as many as its shape says.
YamlMatrix read_matrix(const ConfigNode& node, std::string_view name);

/// Throws DataError unless the matrix has the shape; a vector may lie or stand, and a plain list of
/// as many numbers will do for a matrix.
void expect_shape(const YamlMatrix& matrix, int rows, int cols);

/// A positive whole number. Throws DataError.
int read_count(const ConfigNode& node, std::string_view name);

}  // namespace hypotrack
