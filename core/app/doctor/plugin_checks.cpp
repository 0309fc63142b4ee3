#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <string_view>

#include "doctor/check.hpp"
#include "hypotrack/api/error.hpp"
#include "plugin/folders.hpp"
#include "plugin/inspect.hpp"

namespace hypotrack::doctor {
namespace {

/// Returns the plugins that a recording of a hand is tracked with by `@trackers/recommended`.
std::span<const std::string_view> needed_plugins() {
  static constexpr std::array<std::string_view, 15> kPlugins = {"judge/network",
                                                                "model/hand",
                                                                "objective/plausible_motion",
                                                                "objective/skin",
                                                                "objective/stereo_color",
                                                                "objective/stereo_patch",
                                                                "optimizer/levenberg_marquardt",
                                                                "optimizer/limb_search",
                                                                "optimizer/pipeline",
                                                                "optimizer/pso",
                                                                "output/overlay",
                                                                "output/tables",
                                                                "source/image_sequence",
                                                                "source/video",
                                                                "starter/global_search"};
  return kPlugins;
}

std::string id_of(const PluginRow& row) { return row.kind + "/" + row.name; }

bool is_needed(const PluginRow& row) {
  return std::ranges::count(needed_plugins(), id_of(row)) > 0;
}

bool is_hidden(const PluginRow& row) { return row.problem.starts_with("hidden by "); }

Check check_folder(const std::filesystem::path& folder, std::span<const PluginRow> rows,
                   bool needed) {
  const auto count = std::ranges::count_if(
      rows, [&](const PluginRow& row) { return row.path.parent_path() == folder; });
  Check check{.name = "plugin folder", .needed = needed};
  check.found = fmt::format("{}: {} plugin{}", folder.string(), count, count == 1 ? "" : "s");
  if (count > 0) return check;
  check.state = State::missing;
  if (!std::filesystem::is_directory(folder))
    check.found = folder.string() + ": there is no such folder";
  check.fix = needed ? kInstallCompletely : "correct --plugin-path or HYPOTRACK_PLUGIN_PATH";
  return check;
}

/// Lists the plugins of each kind that can be used.
std::vector<Check> usable_plugins(std::span<const PluginRow> rows) {
  std::map<std::string, std::vector<std::string>> names;
  for (const PluginRow& row : rows)
    if (row.usable()) names[row.kind].push_back(row.name);
  std::vector<Check> out;
  for (const auto& [kind, of_kind] : names)
    out.push_back(
        {.name = kind + " plugins", .found = fmt::format("{}", fmt::join(of_kind, ", "))});
  return out;
}

Check unusable_plugin(const PluginRow& row) {
  return {.name = "plugin " + id_of(row),
          .state = State::broken,
          .needed = is_needed(row),
          .found = fmt::format("{}: {}", row.path.string(), row.problem),
          .fix = "build it again with this hypotrack, or remove the file"};
}

}  // namespace

std::vector<Check> check_plugins(std::span<const std::filesystem::path> extra_folders) try {
  const std::vector<std::filesystem::path> folders =
      detail::plugin_search_path({extra_folders.begin(), extra_folders.end()});
  const std::vector<PluginRow> rows = list_plugins(folders);
  std::vector<Check> out;
  for (const auto& folder : folders)
    out.push_back(check_folder(folder, rows, &folder == &folders.back()));
  std::ranges::copy(usable_plugins(rows), std::back_inserter(out));
  for (const PluginRow& row : rows) {
    if (is_hidden(row))
      out.push_back({.name = "plugin " + id_of(row),
                     .found = fmt::format("{}: {}", row.path.string(), row.problem)});
    else if (!row.usable())
      out.push_back(unusable_plugin(row));
  }
  std::vector<std::string_view> absent;
  for (const std::string_view id : needed_plugins())
    if (std::ranges::find(rows, id, id_of) == rows.end()) absent.push_back(id);
  if (!absent.empty())
    out.push_back({.name = "needed plugins",
                   .state = State::missing,
                   .needed = true,
                   .found = fmt::format("in no plugin folder: {}", fmt::join(absent, ", ")),
                   .fix = kInstallCompletely});
  return out;
} catch (const PluginError& e) {  // of the search path, or the probe program is missing
  return {{.name = "plugins",
           .state = State::broken,
           .needed = true,
           .found = e.what(),
           .fix = "correct HYPOTRACK_PLUGIN_PATH, or build or install hypotrack completely"}};
}

}  // namespace hypotrack::doctor
