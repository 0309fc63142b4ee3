#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "base/file_bytes.hpp"
#include "hypotrack/api/error.hpp"
#include "output/evaluate/evaluation.hpp"
#include "output/run_directory.hpp"

namespace hypotrack::internal {

void expect_row_per_frame(const std::filesystem::path& table, std::size_t rows) {
  const std::filesystem::path file = table.parent_path() / kSummaryFile;
  if (!std::filesystem::exists(file)) return;
  if (const std::string why = why_no_file(file); !why.empty())
    throw DataError(fmt::format("{}: {}; expected the summary of a run", file.string(), why));
  std::ifstream in(file, std::ios::binary);
  const auto summary = nlohmann::json::parse(in, nullptr, false);
  if (!summary.is_object())
    throw DataError(fmt::format(
        "{}: is no JSON object, expected the summary of a run; make the run again", file.string()));
  const auto frames = summary.find("frames");
  if (frames == summary.end() || !frames->is_number_integer() || *frames == rows) return;
  throw DataError(fmt::format(
      "{}: has {} rows, expected {}, one for each frame of {}; make the run again, or copy the "
      "whole table",
      table.string(), rows, frames->dump(), file.string()));
}

}  // namespace hypotrack::internal
