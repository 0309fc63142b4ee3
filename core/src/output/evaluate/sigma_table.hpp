#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "base/csv.hpp"
#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Reads the sigmas of uncertainty.csv, in metres.
class SigmaTable {
 public:
  /// Throws DataError.
  explicit SigmaTable(const std::filesystem::path& file);

  /// Returns the names of the landmarks, in the order of the columns.
  const std::vector<std::string>& names() const { return names_; }
  /// Returns by frame a sigma for each landmark; NaN where the table has none.
  std::map<int, Eigen::VectorXd> by_frame() const;

 private:
  CsvTable table_;
  int frame_;
  std::vector<std::string> names_;
  std::vector<int> columns_;
};

}  // namespace internal
}  // namespace hypotrack
