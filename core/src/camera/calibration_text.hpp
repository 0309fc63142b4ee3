#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/config.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Reads YAML, JSON or XML of cv::FileStorage, or TOML, with hypotrack's own parser of YAML:
/// cv::FileStorage crashes on damaged files and does not locate errors. Of several YAML documents
/// that are equal but for their `header` it returns the first. Throws DataError on other XML and
/// compressed files, files over 8 MiB, documents that differ and broken text.
ConfigNode read_calibration_text(const std::filesystem::path& file);

/// Returns whether a text is XML of cv::FileStorage.
bool is_opencv_xml(std::string_view text);

/// Returns such a text as JSON. Throws DataError, naming `file`, if it is damaged.
std::string opencv_xml_as_json(const std::string& text, const std::string& file);

/// A matrix of a YAML file: `!!opencv-matrix` with rows, cols, dt and data, a plain list of numbers
/// (one row), or a list of rows.
struct YamlMatrix {
  int rows = 0;
  int cols = 0;
  std::vector<double> values;  ///< row by row, finite
  std::string where;           ///< `extrinsics.yml:3:4: R`
};

/// Reads a matrix of finite numbers. Throws DataError, naming file, line and `name`, for other
/// nodes and for a number of values that does not fit its shape.
YamlMatrix read_matrix(const ConfigNode& node, std::string_view name);

/// Throws DataError unless the matrix has this shape. A row vector may replace a column vector, and
/// a plain list of the right length may replace a matrix.
void expect_shape(const YamlMatrix& matrix, int rows, int cols);

/// Returns whether a matrix is absent, empty or full of zeros, as of cameras without a calibration.
bool is_unknown_matrix(const ConfigNode& node, std::string_view name);

/// Reads a finite number. Throws DataError.
double read_number(const ConfigNode& node, std::string_view name);

/// Reads a positive integer. Throws DataError.
int read_count(const ConfigNode& node, std::string_view name);

}  // namespace internal
}  // namespace hypotrack
