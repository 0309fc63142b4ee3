#include "output/evaluate/sigma_table.hpp"

#include <fmt/format.h>

#include <string_view>

#include "hypotrack/api/error.hpp"

namespace hypotrack::internal {

SigmaTable::SigmaTable(const std::filesystem::path& file)
    : table_(file), frame_(table_.find("frame")) {
  for (const std::string_view name : table_.columns()) {
    if (name == "frame" || name == "time") continue;
    names_.emplace_back(name);
    columns_.push_back(table_.find(name));
  }
  if (frame_ < 0 || names_.empty())
    throw DataError(
        fmt::format("{}: expected frame, time and a column for each landmark", file.string()));
}

std::map<int, Eigen::VectorXd> SigmaTable::by_frame() const {
  std::map<int, Eigen::VectorXd> frames;
  for (const CsvTable::Row& row : table_.rows()) {
    Eigen::VectorXd& sigma = frames[table_.frame(row, frame_)];
    sigma.resize(static_cast<Eigen::Index>(columns_.size()));
    for (std::size_t i = 0; i < columns_.size(); ++i)
      sigma[static_cast<Eigen::Index>(i)] = 1e-3 * table_.number(row, columns_[i], true);
  }
  return frames;
}

}  // namespace hypotrack::internal
