#include <fmt/format.h>

#include <cmath>

#include "base/csv.hpp"
#include "base/machine.hpp"
#include "base/text_file.hpp"
#include "hypotrack/api/error.hpp"
#include "lab/bench/bench_numbers.hpp"
#include "lab/bench/bench_table.hpp"
#include "lab/json_file.hpp"

namespace hypotrack::bench::internal {
namespace {

/// Rounds to six digits, more than repeat between runs. NaN becomes null.
Json number(double value) {
  return std::isnan(value) ? Json() : Json(std::stod(fmt::format("{:.6g}", value)));
}

Json json_of(const Plan& plan, const Row& row, const std::vector<Row>& rows) {
  const Measurement& m = row.measurement;
  const auto n = numbers_of(m);
  Json json;
  json["scene"] = plan.cases[row.case_index].label;
  json["backend"] = plan.configurations[row.configuration].name;
  json["round"] = row.round;
  json["status"] = to_string(m.outcome);
  json["device"] = m.device;
  json["frames"] = m.seconds.size();
  json["warm_up"] = m.warm_up;
  json["median_ms"] = n ? number(1000 * n->median) : Json();
  json["p5_ms"] = n ? number(1000 * n->p5) : Json();
  json["p95_ms"] = n ? number(1000 * n->p95) : Json();
  json["fps"] = n ? number(n->fps) : Json();
  json["evaluations"] = n ? number(n->evaluations) : Json();
  json["evaluations_per_second"] = n ? number(n->evaluations_per_second) : Json();
  json["mean_error_mm"] = n ? number(m.metrics.mean_error_mm) : Json();
  json["lost_frames"] = n ? Json(m.metrics.lost_frames) : Json();
  json["tracked_share"] = n ? number(m.metrics.status.tracked_share) : Json();
  json["device_mib"] = n && m.device_mib ? number(*m.device_mib) : Json();
  for (std::size_t configuration = 0; configuration < plan.configurations.size(); ++configuration) {
    const auto speed = speed_over(row, configuration, rows);
    json["speed_over_" + plan.configurations[configuration].name] = speed ? number(*speed) : Json();
  }
  json["message"] = m.message;
  return json;
}

std::string csv_text(const Json& rows) {
  std::string text;
  for (const Json& row : rows) {
    std::string head, line;
    for (const auto& [key, value] : row.items()) {
      head += (head.empty() ? "" : ",") + csv_cell(key);
      line += line.empty() ? "" : ",";
      if (!value.is_null())
        line += csv_cell(value.is_string() ? value.get<std::string>() : value.dump());
    }
    if (text.empty()) text = head + "\n";
    text += line + "\n";
  }
  return text;
}

}  // namespace

void check_format(const std::filesystem::path& file) {
  if (file.extension() != ".csv" && file.extension() != ".json")
    throw ConfigError(
        fmt::format("--out {}: expected a name that ends in .csv or .json", file.string()));
}

void write_rows(const std::filesystem::path& file, const Plan& plan, const std::vector<Row>& rows) {
  Json table = Json::array();
  for (const Row& row : rows) table.push_back(json_of(plan, row, rows));
  if (file.extension() == ".csv") return write_whole(file, csv_text(table));
  const Json whole = {{"title", plan.title},
                      {"version", HYPOTRACK_VERSION},
                      {"processor", processor_name()},
                      {"cores", core_count()},
                      {"rows", table}};
  write_whole(file, whole.dump(2) + "\n");
}

}  // namespace hypotrack::bench::internal
