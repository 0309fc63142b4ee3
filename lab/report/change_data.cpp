#include "lab/report/change_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "base/csv.hpp"
#include "base/statistics.hpp"
#include "base/text_file.hpp"
#include "hypotrack/api/error.hpp"
#include "lab/json_file.hpp"
#include "lab/report/packed.hpp"
#include "lab/report/statistics/significance.hpp"
#include "lab/report/tables/cells.hpp"

namespace hypotrack::internal {
namespace {

constexpr const char* kMainError = "mean_error_mm";

/// What a cell is compared in, what it costs first.
const std::vector<std::string> kCompared{
    kMainError,     "lost_share",   "lost_frames",         "evaluations_per_frame", "fps",
    "p95_error_mm", "success_20mm", "false_tracked_share", "recovered_10_share"};

struct Pair {
  StudyCell before, after;
};

/// One metric of a cell, before and after.
struct Change {
  double before = 0, after = 0;  ///< means; NaN without values
  double sd = 0;                 ///< of the differences of equal seeds; NaN without pairs
  bool tested = false;
  bool same = false;  ///< all values are equal
  double p = 1;       ///< corrected
  std::optional<int> seeds_needed;
};

/// Returns the cells of a scene that both studies have.
std::vector<Pair> pairs_of(const StudyData& before, const StudyData& after,
                           const std::string& scene) {
  const std::vector<StudyCell> others = cells_of(after, scene);
  const auto named = [](const StudyData& study, const StudyCell& cell) {
    std::map<std::string, std::string> settings;
    for (std::size_t i = 0; i < study.axes.size(); ++i)
      settings[study.axes[i].key] = cell.settings[i];
    return settings;
  };
  std::vector<Pair> pairs;
  for (const StudyCell& cell : cells_of(before, scene)) {
    const auto other = std::find_if(others.begin(), others.end(), [&](const StudyCell& o) {
      return named(after, o) == named(before, cell);
    });
    if (other != others.end()) pairs.push_back({cell, *other});
  }
  return pairs;
}

Change compare(const Sample& before, const Sample& after) {
  Change change;
  change.before = mean(before.values);
  change.after = mean(after.values);
  change.same = before.values == after.values;
  change.sd = std::nan("");
  if (before.seeds == after.seeds) {
    std::vector<double> differences;
    for (std::size_t i = 0; i < before.values.size(); ++i)
      differences.push_back(after.values[i] - before.values[i]);
    change.sd = sample_deviation(differences);
  }
  return change;
}

/// Compares all pairs in a metric and corrects the tests for their number.
std::vector<Change> compare_all(const std::vector<Pair>& pairs, const MetricInfo& metric) {
  std::vector<Change> changes;
  std::vector<Sample> before, after;
  std::vector<std::size_t> tested;
  std::vector<double> p_values;
  for (const Pair& pair : pairs) {
    before.push_back(sample_of(pair.before.runs, metric));
    after.push_back(sample_of(pair.after.runs, metric));
    changes.push_back(compare(before.back(), after.back()));
    if (before.back().values.empty() || after.back().values.empty()) continue;
    if (metric.better == MetricInfo::Better::neither) continue;
    changes.back().tested = true;
    tested.push_back(changes.size() - 1);
    p_values.push_back(test_difference(before.back(), after.back()));
  }
  const std::vector<double> corrected = holm(p_values);
  const double alpha = kSignificant / static_cast<double>(std::max<std::size_t>(tested.size(), 1));
  for (std::size_t k = 0; k < tested.size(); ++k) {
    Change& change = changes[tested[k]];
    change.p = corrected[k];
    if (change.p >= kSignificant)
      change.seeds_needed = seeds_needed(before[tested[k]], after[tested[k]], alpha);
  }
  return changes;
}

const char* verdict_of(const Change& change, MetricInfo::Better better) {
  if (!change.tested) return "";
  if (change.same) return "same";
  if (change.p >= kSignificant) return "open";
  return (change.after < change.before) == (better == MetricInfo::Better::lower) ? "better"
                                                                                 : "worse";
}

Json to_json(const Change& change, MetricInfo::Better better) {
  return {{"before", number_or_null(change.before)},
          {"after", number_or_null(change.after)},
          {"difference", number_or_null(change.after - change.before)},
          {"sd", number_or_null(change.sd)},
          {"p", change.tested ? Json(change.p) : Json()},
          {"verdict", verdict_of(change, better)},
          {"seeds_needed", change.seeds_needed ? Json(*change.seeds_needed) : Json()}};
}

bool measured(const std::vector<Pair>& pairs, const std::string& key) {
  return std::any_of(pairs.begin(), pairs.end(), [&](const Pair& pair) {
    return !sample_of(pair.before.runs, metric_info(key)).values.empty() &&
           !sample_of(pair.after.runs, metric_info(key)).values.empty();
  });
}

Json scene_changes(const StudyData& before, const StudyScene& scene, std::size_t number,
                   const std::vector<Pair>& pairs) {
  Json table{{"id", fmt::format("change-{}", number)}, {"title", scene.label}};
  table["note"] = fmt::format(
      "Before → after, and the difference ± its standard deviation over equal seeds. Tests as in "
      "reports of one study (p < {}), Holm correction for {} cell{}. A number after ≈ says how "
      "many seeds would find the difference seen with a power of 80 %.",
      kSignificant, pairs.size(), pairs.size() == 1 ? "" : "s");
  table["keys"] = Json::array();
  for (const StudyAxis& axis : before.axes) table["keys"].push_back(axis.label);
  table["columns"] = Json::array();
  table["rows"] = Json::array();
  for (const Pair& pair : pairs)
    table["rows"].push_back({{"keys", pair.before.settings},
                             {"before", distinct_runs(pair.before.runs).size()},
                             {"after", distinct_runs(pair.after.runs).size()},
                             {"cells", Json::array()}});
  for (const std::string& key : kCompared) {
    if (!measured(pairs, key)) continue;
    if (key == "lost_frames" && measured(pairs, "lost_share")) continue;
    const MetricInfo metric = metric_info(key);
    table["columns"].push_back(
        {{"key", key}, {"label", metric.label_with_unit()}, {"digits", metric.digits}});
    const std::vector<Change> changes = compare_all(pairs, metric);
    for (std::size_t i = 0; i < pairs.size(); ++i)
      table["rows"][i]["cells"].push_back(to_json(changes[i], metric.better));
  }
  return table;
}

/// Counts the cells whose error got better, worse or neither.
Json facts_of(const Json& tables) {
  std::map<std::string, int> count;
  int cells = 0;
  for (const Json& table : tables)
    for (const Json& row : table["rows"]) {
      ++cells;
      for (std::size_t i = 0; i < table["columns"].size(); ++i)
        if (table["columns"][i]["key"] == kMainError)
          ++count[row["cells"][i]["verdict"].get<std::string>()];
    }
  Json facts = Json::array({Json::array({"cells compared", fmt::format("{}", cells)})});
  const auto add = [&](const char* name, const char* verdict) {
    facts.push_back(Json::array({name, fmt::format("{}", count[verdict])}));
  };
  add("error better", "better");
  add("error worse", "worse");
  add("error not separated", "open");
  add("error the same", "same");
  return facts;
}

void require_study(const StudyData& study) {
  if (study.is_study) return;
  throw DataError(
      fmt::format("{}: is a run; expected the folders of a study before and after a change, which "
                  "`hypotrack compare` wrote",
                  study.title));
}

std::size_t count_cells(const StudyData& study) {
  std::size_t count = 0;
  for (const StudyScene& scene : study.scenes) count += cells_of(study, scene.name).size();
  return count;
}

}  // namespace

Json change_data(const StudyData& before, const StudyData& after) {
  require_study(before);
  require_study(after);
  Json tables = Json::array();
  std::size_t common = 0;
  for (const StudyScene& scene : before.scenes) {
    const std::vector<Pair> pairs = pairs_of(before, after, scene.name);
    common += pairs.size();
    if (!pairs.empty()) tables.push_back(scene_changes(before, scene, tables.size() + 1, pairs));
  }
  if (common == 0)
    throw DataError(
        fmt::format("the studies '{}' and '{}' have no cell in common, which needs a scene of the "
                    "same name and the same settings; expected one study before and after a change",
                    before.title, after.title));
  const std::size_t alone = count_cells(before) + count_cells(after) - 2 * common;
  Json page{{"kind", "change"},
            {"title", before.title == after.title ? before.title + ": before and after"
                                                  : before.title + " → " + after.title},
            {"about", before.about},
            {"version", HYPOTRACK_VERSION},
            {"left_out", ""}};
  if (alone > 0)
    page["left_out"] = fmt::format("{} cell{} of one study only {} left out.", alone,
                                   alone == 1 ? "" : "s", alone == 1 ? "is" : "are");
  page["facts"] = facts_of(tables);
  page["tables"] = std::move(tables);
  return page;
}

void write_change_files(const Json& tables, const std::filesystem::path& directory) {
  const auto cell = [](const Json& value) {
    if (value.is_null()) return std::string();
    return csv_cell(value.is_string() ? value.get<std::string>() : value.dump());
  };
  constexpr std::array<const char*, 6> kParts{"before", "after",   "difference",
                                              "p",      "verdict", "seeds_needed"};
  for (const Json& table : tables) {
    std::string text;
    for (const Json& key : table["keys"]) text += cell(key) + ",";
    text += "samples_before,samples_after";
    for (const Json& column : table["columns"])
      for (const char* part : kParts)
        text += fmt::format(",{}_{}", column["key"].get<std::string>(), part);
    text += "\n";
    for (const Json& row : table["rows"]) {
      for (const Json& key : row["keys"]) text += cell(key) + ",";
      text += cell(row["before"]) + "," + cell(row["after"]);
      for (const Json& entry : row["cells"])
        for (const char* part : kParts) text += "," + cell(entry[part]);
      text += "\n";
    }
    TextFile(directory / (table["id"].get<std::string>() + ".csv")).write(text);
  }
}

}  // namespace hypotrack::internal
