#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "camera/calibration_text.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack::internal {
namespace {

constexpr int kLargestSide = 65536;

std::string name_at(const ConfigNode& node, std::string_view name) {
  return fmt::format("{}: {}", node.where(), name);
}

void append_numbers(const ConfigNode& list, std::string_view name, std::vector<double>& values) {
  for (std::size_t i = 0; i < list.size(); ++i) values.push_back(read_number(list.at(i), name));
}

YamlMatrix read_opencv_matrix(const ConfigNode& node, std::string_view name) {
  for (const char* key : {"rows", "cols", "data"}) {
    if (!node.get(key).defined()) {
      throw DataError(fmt::format("{} has no '{}'; expected a matrix with rows, cols and data",
                                  name_at(node, name), key));
    }
  }
  YamlMatrix matrix;
  matrix.rows = read_count(node.get("rows"), name);
  matrix.cols = read_count(node.get("cols"), name);
  const std::string type = node.get("dt").defined() ? node.get("dt").scalar() : "d";
  constexpr std::string_view kNumbers = "ucwsifd";  // from bytes to double
  if (type.size() != 1 || kNumbers.find(type) == kNumbers.npos) {
    throw DataError(
        fmt::format("{} has elements of type '{}'; expected one of u, c, w, s, i, f and d (one "
                    "channel of numbers)",
                    name_at(node.get("dt"), name), type.substr(0, 40)));
  }
  const ConfigNode data = node.get("data");
  if (!data.is_list()) {
    throw DataError(fmt::format("{} has data that is no list of numbers", name_at(data, name)));
  }
  append_numbers(data, name, matrix.values);
  const auto expected =
      static_cast<std::size_t>(matrix.rows) * static_cast<std::size_t>(matrix.cols);
  if (matrix.values.size() != expected) {
    throw DataError(fmt::format("{} has {} numbers; expected {} x {} = {}", name_at(data, name),
                                matrix.values.size(), matrix.rows, matrix.cols, expected));
  }
  return matrix;
}

YamlMatrix read_plain_matrix(const ConfigNode& node, std::string_view name) {
  YamlMatrix matrix;
  matrix.rows = 1;
  if (node.size() > 0 && node.at(0).is_list()) {
    matrix.rows = static_cast<int>(node.size());
    for (std::size_t i = 0; i < node.size(); ++i) {
      if (node.at(i).size() != node.at(0).size() || !node.at(i).is_list()) {
        throw DataError(fmt::format("{} has rows of unequal length", name_at(node.at(i), name)));
      }
      append_numbers(node.at(i), name, matrix.values);
    }
    matrix.cols = static_cast<int>(node.at(0).size());
  } else {
    append_numbers(node, name, matrix.values);
    matrix.cols = static_cast<int>(matrix.values.size());
  }
  return matrix;
}

}  // namespace

double read_number(const ConfigNode& node, std::string_view name) {
  const std::string& text = node.scalar();
  std::string_view rest = text;
  if (rest.starts_with('+')) rest.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
  const bool read =
      node.is_scalar() && !rest.empty() && error == std::errc{} && end == rest.data() + rest.size();
  if (!read || !std::isfinite(value)) {
    throw DataError(fmt::format("{} holds '{}'; expected finite numbers", name_at(node, name),
                                node.is_scalar() ? text.substr(0, 40) : "a map or list"));
  }
  return value;
}

YamlMatrix read_matrix(const ConfigNode& node, std::string_view name) {
  if (!node.is_map() && !node.is_list()) {
    throw DataError(fmt::format("{} is no matrix; expected `!!opencv-matrix` or a list of numbers",
                                name_at(node, name)));
  }
  YamlMatrix matrix =
      node.is_map() ? read_opencv_matrix(node, name) : read_plain_matrix(node, name);
  matrix.where = name_at(node, name);
  return matrix;
}

void expect_shape(const YamlMatrix& matrix, int rows, int cols) {
  const bool same = matrix.rows == rows && matrix.cols == cols;
  const bool turned = (rows == 1 || cols == 1) && matrix.rows == cols && matrix.cols == rows;
  const bool listed = matrix.rows == 1 && matrix.cols == rows * cols;
  if (same || turned || listed) return;
  throw DataError(fmt::format("{} is {} x {}; expected {} x {}", matrix.where, matrix.rows,
                              matrix.cols, rows, cols));
}

bool is_unknown_matrix(const ConfigNode& node, std::string_view name) {
  if (!node.defined() || node.is_null() || (node.is_list() && node.size() == 0)) return true;
  return std::ranges::all_of(read_matrix(node, name).values, [](double v) { return v == 0; });
}

int read_count(const ConfigNode& node, std::string_view name) {
  const double value = read_number(node, name);
  if (value < 1 || value > kLargestSide || value != std::floor(value)) {
    throw DataError(fmt::format("{} is {}; expected a whole number from 1 to {}",
                                name_at(node, name), value, kLargestSide));
  }
  return static_cast<int>(value);
}

}  // namespace hypotrack::internal
