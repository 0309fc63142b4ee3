#include "hypotrack/api/tables.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "base/csv.hpp"
#include "base/text_file.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/text.hpp"
#include "output/table_text.hpp"

namespace hypotrack {
namespace {

constexpr double kFarthest = 1e6;  // metres; models farther away are not drawn

/// Returns the index in `names` of the name that a column means: the name itself, or the name
/// without its model if that is unique.
std::optional<std::size_t> resolve(std::string_view column, std::span<const std::string> names) {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == column) return i;
    const std::size_t dot = names[i].find('.');
    if (dot != std::string::npos && std::string_view(names[i]).substr(dot + 1) == column) {
      if (found) return std::nullopt;
      found = i;
    }
  }
  return found;
}

/// Returns the column of every name, -1 where the table has none.
std::vector<int> columns_of(const CsvTable& table, std::span<const std::string> names) {
  std::vector<int> columns(names.size(), -1);
  for (std::size_t c = 0; c < table.columns().size(); ++c) {
    const auto index = resolve(table.columns()[c], names);
    // A full name beats one that leaves out the model.
    if (index && (columns[*index] < 0 || names[*index] == table.columns()[c])) {
      columns[*index] = static_cast<int>(c);
    }
  }
  return columns;
}

/// Frame numbers and times of a table, and the order that sorts it by frame.
struct Timeline {
  std::vector<int> frames;
  std::vector<double> times;
  std::vector<std::size_t> order;
};

Timeline read_timeline(const CsvTable& table) {
  const int frame_column = table.find("frame");
  const int time_column = table.find("time");
  Timeline timeline;
  std::map<int, std::size_t> first;
  for (std::size_t i = 0; i < table.rows().size(); ++i) {
    const CsvTable::Row& row = table.rows()[i];
    const int frame = frame_column < 0 ? static_cast<int>(i) : table.frame(row, frame_column);
    if (const auto [it, is_new] = first.emplace(frame, i); !is_new) {
      throw DataError(fmt::format("{}: frame {} is there a second time; the first is on line {}",
                                  table.where(row), frame, table.rows()[it->second].line));
    }
    timeline.frames.push_back(frame);
    const double time = time_column < 0 ? 0.0 : table.number(row, time_column, false);
    if (!std::isfinite(time)) {
      throw DataError(
          fmt::format("{}: the time is {}; expected finite seconds", table.where(row), time));
    }
    timeline.times.push_back(time);
  }
  for (const auto& [frame, index] : first) timeline.order.push_back(index);
  return timeline;
}

struct Triple {
  int landmark = 0;
  std::array<int, 3> columns{};
};

using Renames = std::map<std::string, std::string, std::less<>>;

Renames read_renames(std::span<const std::string> entries, const std::string& file) {
  Renames renames;
  for (const std::string& entry : entries) {
    const std::size_t equals = entry.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw DataError(fmt::format(
          "{}: the renaming '{}' is not understood; expected 'name in the table=landmark', or "
          "'name=' to drop it",
          file, entry));
    }
    renames.emplace(entry.substr(0, equals), entry.substr(equals + 1));
  }
  return renames;
}

/// Throws if a renaming names a column that the table does not have: it is a typing error.
void check_renames(const Renames& renames, const CsvTable& table, const std::string& file) {
  std::vector<std::string> bases;
  for (const std::string_view column : table.columns())
    if (column.ends_with("_x")) bases.emplace_back(column.substr(0, column.size() - 2));
  for (const auto& [name, landmark] : renames) {
    if (std::find(bases.begin(), bases.end(), name) != bases.end()) continue;
    throw DataError(fmt::format("{}: has no landmark '{}' that the renaming '{}={}' could mean{}",
                                file, name, name, landmark, did_you_mean(name, bases)));
  }
}

std::vector<Triple> find_triples(const CsvTable& table, const std::string& file,
                                 std::span<const std::string> names,
                                 const LandmarkTableOptions& options) {
  const Renames renames = read_renames(options.rename, file);
  check_renames(renames, table, file);
  const std::vector<std::string> offered(names.begin(), names.end());
  std::vector<Triple> triples;
  std::vector<bool> taken(names.size());
  for (std::size_t c = 0; c < table.columns().size(); ++c) {
    const std::string column(table.columns()[c]);
    if (column == "frame" || column == "time") continue;
    const std::string base = column.substr(0, column.size() < 2 ? 0 : column.size() - 2);
    const std::array<int, 3> xyz = {table.find(base + "_x"), table.find(base + "_y"),
                                    table.find(base + "_z")};
    if (base.empty() || *std::min_element(xyz.begin(), xyz.end()) < 0) {
      throw DataError(
          fmt::format("{}: the column '{}' belongs to no landmark; expected frame, time "
                      "and columns <landmark>_x, _y and _z",
                      file, column));
    }
    if (xyz[0] != static_cast<int>(c)) continue;  // once per triple
    const auto renamed = renames.find(base);
    const std::string name = renamed == renames.end() ? base : renamed->second;
    if (name.empty()) continue;
    const auto index = resolve(name, names);
    if (!index) {
      throw DataError(
          fmt::format("{}: '{}' is no landmark of {}; rename it with "
                      "'{}=<landmark>' or drop it with '{}='{}",
                      file, name, options.owner, base, base, did_you_mean(name, offered)));
    }
    if (taken[*index]) {
      throw DataError(fmt::format("{}: the landmark '{}' is there twice", file, names[*index]));
    }
    taken[*index] = true;
    triples.push_back({static_cast<int>(*index), xyz});
  }
  return triples;
}

bool is_absent(const CsvTable::Row& row, const Triple& triple) {
  return std::all_of(triple.columns.begin(), triple.columns.end(), [&](int column) {
    return row.cells[static_cast<std::size_t>(column)] == kAbsent;
  });
}

/// Throws if a row has a rotation of length 0, which is none. Other lengths are normalised.
void check_rotations(const StateRow& row, const Scene& scene, const std::string& where) {
  constexpr double kShortest = 1e-3;
  for (const Scene::Item& item : scene.items())
    if (row.state.segment<4>(item.offset + 3).norm() < kShortest)
      throw DataError(fmt::format(
          "{}: the rotation of '{}' has the length 0; expected a quaternion, 1, 0, 0, 0 for none",
          where, item.name));
}

}  // namespace

std::vector<StateRow> read_states(const std::filesystem::path& file, const Scene& scene) {
  const CsvTable table(file);
  std::vector<std::string> names;
  for (const Parameter& p : scene.parameters()) names.push_back(p.name);
  const std::vector<int> columns = columns_of(table, names);
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (columns[i] >= 0) continue;
    std::vector<std::string> offered;  // candidates for a misspelt column
    for (const std::string_view column : table.columns()) {
      if (!resolve(column, names)) offered.emplace_back(column);
    }
    throw DataError(
        fmt::format("{}: has no column '{}'; a table of states has one for each of the "
                    "scene's {} parameters{}",
                    file.string(), names[i], names.size(), did_you_mean(names[i], offered)));
  }
  const Timeline timeline = read_timeline(table);
  std::vector<StateRow> rows;
  for (const std::size_t i : timeline.order) {
    StateRow row{timeline.frames[i], timeline.times[i], Eigen::VectorXd(scene.dimension())};
    for (std::size_t k = 0; k < names.size(); ++k) {
      const double value = table.number(table.rows()[i], columns[k], false);
      if (!(std::abs(value) <= kFarthest)) {
        throw DataError(fmt::format("{}: '{}' is {}; expected a finite number, {:g} at most",
                                    table.where(table.rows()[i]), names[k], value, kFarthest));
      }
      row.state[static_cast<Eigen::Index>(k)] = value;
    }
    check_rotations(row, scene, table.where(table.rows()[i]));
    scene.normalize(row.state);
    rows.push_back(std::move(row));
  }
  return rows;
}

std::vector<LandmarkRow> read_landmarks(const std::filesystem::path& file,
                                        std::span<const std::string> landmark_names,
                                        const LandmarkTableOptions& options) {
  const CsvTable table(file);
  const std::vector<Triple> triples = find_triples(table, file.string(), landmark_names, options);
  const Timeline timeline = read_timeline(table);
  std::vector<LandmarkRow> rows;
  for (const std::size_t i : timeline.order) {
    LandmarkRow row{timeline.frames[i], timeline.times[i], {}};
    row.landmarks.setConstant(3, static_cast<Eigen::Index>(landmark_names.size()),
                              std::numeric_limits<double>::quiet_NaN());
    for (const Triple& triple : triples) {
      if (is_absent(table.rows()[i], triple)) {
        row.absent.resize(landmark_names.size());
        row.absent[static_cast<std::size_t>(triple.landmark)] = true;
        continue;
      }
      Eigen::Vector3d p;
      for (int k = 0; k < 3; ++k) {
        p[k] = table.number(table.rows()[i], triple.columns[static_cast<std::size_t>(k)], true);
      }
      if ((options.metres_per_unit * p.array().abs() > kFarthest).any()) {
        throw DataError(fmt::format(
            "{}: '{}' is ({}), too far away; expected metres up to {:g} in "
            "the table's unit, or nan where unknown",
            table.where(table.rows()[i]), landmark_names[static_cast<std::size_t>(triple.landmark)],
            fmt::join(p, ", "), kFarthest));
      }
      if (p.allFinite()) row.landmarks.col(triple.landmark) = options.metres_per_unit * p;
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

void write_states(const std::filesystem::path& file, const Scene& scene,
                  std::span<const StateRow> rows) {
  std::string text = states_header(scene);
  for (const StateRow& row : rows) text += table_line(row.frame, row.time, row.state);
  write_whole(file, text);
}

void write_landmarks(const std::filesystem::path& file, std::span<const std::string> landmark_names,
                     std::span<const LandmarkRow> rows) {
  std::string text = landmarks_header(landmark_names);
  for (const LandmarkRow& row : rows)
    text += landmarks_line(row.frame, row.time, row.landmarks, row.absent);
  write_whole(file, text);
}

}  // namespace hypotrack
