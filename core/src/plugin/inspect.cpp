#include "plugin/inspect.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <system_error>

#include "base/subprocess.hpp"
#include "base/system_problem.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/text.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "plugin/capabilities.hpp"
#include "plugin/folders.hpp"
#include "plugin/library.hpp"

namespace hypotrack::internal {
namespace {

/// Returns the complete lines of a report.
std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines;
  for (std::size_t end; (end = text.find('\n')) != text.npos; text.remove_prefix(end + 1))
    lines.emplace_back(text.substr(0, end));
  return lines;
}

Captured probe_library(const std::filesystem::path& library, std::chrono::milliseconds limit) {
  const auto program = detail::probe_program();
  try {
    return capture_output({program, {library.string()}}, {detail::kProbeDescriptor}, {limit});
  } catch (const std::system_error& error) {
    if (is_shortage(error.code().value())) throw PluginError(described(error));
    throw PluginError(fmt::format(
        "{}; it is part of hypotrack, so build or install that completely", error.what()));
  }
}

/// Describes the failure of a probe whose report, of some steps, has no result.
std::string describe_end(const Captured& probe, const std::vector<std::string>& steps,
                         std::chrono::milliseconds limit) {
  const std::string step = steps.empty() ? "while starting" : steps.back();
  if (probe.timed_out) {
    return fmt::format("hung: did not finish within {:g} s {}",
                       static_cast<double>(limit.count()) / 1e3, step);
  }
  if (probe.end.signal) return fmt::format("crashed: {} {}", signal_name(probe.end.signal), step);
  return fmt::format("ended the program with exit code {} {}", probe.end.code, step);
}

void fill(PluginRow& row, const nlohmann::json& report) {
  row.version = report.value("version", "");
  row.summary = report.value("summary", "");
  row.licence = report.value("licence", "");
  row.capabilities = report.value("capabilities", "");
  row.parameters = report.value("parameters", "");
  row.problem = report.value("problem", "");
}

PluginRow row_of(const std::filesystem::path& file) {
  PluginRow row;
  row.path = std::filesystem::absolute(file).lexically_normal();
  if (const auto id = detail::id_from_file_name(row.path)) {
    row.kind = id->kind;
    row.name = id->name;
  }
  return row;
}

/// Lists the libraries on the search path by their file names, sorted. Of equal names, hidden
/// libraries come last.
std::vector<PluginRow> find_libraries(std::span<const std::filesystem::path> search_path) {
  std::vector<PluginRow> rows;
  for (const auto& folder : search_path) {
    std::error_code unreadable;
    for (const auto& entry : std::filesystem::directory_iterator(folder, unreadable)) {
      PluginRow row = row_of(entry.path());
      if (row.name.empty()) continue;
      const auto first = std::find_if(rows.begin(), rows.end(), [&](const PluginRow& other) {
        return other.kind == row.kind && other.name == row.name;
      });
      if (first != rows.end()) row.problem = "hidden by " + first->path.string();
      rows.push_back(std::move(row));
    }
  }
  std::stable_sort(rows.begin(), rows.end(), [](const PluginRow& a, const PluginRow& b) {
    return std::tie(a.kind, a.name) < std::tie(b.kind, b.name);
  });
  return rows;
}

void inspect(std::vector<PluginRow>& rows, std::chrono::milliseconds limit) {
  for (PluginRow& row : rows) {
    if (row.problem.empty()) row = check_plugin(row.path, limit);
  }
}

std::string plural(std::size_t count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

/// Returns a line per capability of a plugin. Those of others may be words that nobody knows here.
std::string capability_lines(const PluginRow& row) {
  std::string out;
  std::istringstream words(row.capabilities);
  for (std::string word; words >> word;) {
    const Capability* known = find_capability(row.kind, word);
    out += known ? fmt::format("  {}: {}\n", word, known->meaning) : fmt::format("  {}\n", word);
  }
  return out;
}

}  // namespace

PluginRow check_plugin(const std::filesystem::path& file, std::chrono::milliseconds limit) {
  PluginRow row = row_of(file);
  if (!std::filesystem::is_regular_file(row.path)) {
    row.problem = std::filesystem::exists(row.path) ? "is no file" : "there is no such file";
    return row;
  }
  const Captured probe = probe_library(row.path, limit);
  const std::vector<std::string> lines = lines_of(probe.output);
  const auto report =
      lines.empty() ? nlohmann::json() : nlohmann::json::parse(lines.back(), nullptr, false);
  if (report.is_object()) {
    fill(row, report);
  } else {
    row.problem = describe_end(probe, lines, limit);
  }
  return row;
}

std::vector<PluginRow> list_plugins(std::span<const std::filesystem::path> search_path,
                                    std::chrono::milliseconds limit) {
  auto rows = find_libraries(search_path);
  inspect(rows, limit);
  return rows;
}

std::vector<PluginRow> find_plugins(std::span<const std::filesystem::path> search_path,
                                    std::string_view what, std::chrono::milliseconds limit) {
  auto rows = find_libraries(search_path);
  std::set<std::string> words;
  for (const PluginRow& row : rows) words.insert({row.kind, row.name, row.kind + "/" + row.name});
  std::erase_if(rows, [&](const PluginRow& row) {
    return what != row.kind && what != row.name && what != row.kind + "/" + row.name;
  });
  if (rows.empty()) {
    const std::vector<std::string> candidates(words.begin(), words.end());
    const std::string hint = did_you_mean(what, candidates);
    std::vector<std::string> folders;
    for (const auto& folder : search_path) folders.push_back(folder.string());
    throw PluginError(fmt::format("there is no plugin or kind of plugin '{}'{} Searched in {}",
                                  what, hint.empty() ? "." : hint, fmt::join(folders, ", ")));
  }
  inspect(rows, limit);
  return rows;
}

std::string format_table(std::span<const PluginRow> rows) {
  std::size_t kind = 4;
  std::size_t name = 4;
  std::size_t version = 7;
  std::size_t licence = 7;
  for (const PluginRow& row : rows) {
    kind = std::max(kind, row.kind.size());
    name = std::max(name, row.name.size());
    version = std::max(version, row.version.size());
    licence = std::max(licence, row.licence.size());
  }
  const auto line = [&](const auto& k, const auto& n, const auto& v, const auto& l, const auto& s) {
    return fmt::format("{:<{}}  {:<{}}  {:<{}}  {:<{}}  {}\n", k, kind, n, name, v, version, l,
                       licence, s);
  };
  std::string text = line("KIND", "NAME", "VERSION", "LICENCE", "SUMMARY");
  for (const PluginRow& row : rows) {
    text += row.usable() ? line(row.kind, row.name, row.version, row.licence, row.summary)
                         : line(row.kind, row.name, "-", "-", "UNUSABLE: " + row.problem);
  }
  const auto broken =
      std::count_if(rows.begin(), rows.end(), [](auto& row) { return !row.usable(); });
  text += plural(rows.size(), "plugin");
  return text + (broken ? fmt::format(", {} of them unusable\n", broken) : "\n");
}

std::string format_info(const PluginRow& row) {
  if (!row.usable()) {
    return fmt::format("{} '{}' cannot be used: {}\n  library       {}\n", row.kind, row.name,
                       row.problem, row.path.string());
  }
  return fmt::format(
      "{} '{}' {}: {}\n"
      "  licence       {}\n"
      "  library       {}\n"
      "capabilities{}\n{}"
      "parameters{}\n{}",
      row.kind, row.name, row.version, row.summary, row.licence, row.path.string(),
      row.capabilities.empty() ? ": none" : "", capability_lines(row),
      row.parameters.empty() ? ": none" : "", row.parameters);
}

std::string format_check(const PluginRow& row) {
  if (!row.usable()) return fmt::format("{}: {}\n", row.path.string(), row.problem);
  // Those of another minor version, which have another number, cannot be loaded.
  return fmt::format("{}: {} '{}' {} can be used; it was built for hypotrack {}, plugin ABI {}\n",
                     row.path.string(), row.kind, row.name, row.version, detail::minor_version(),
                     kAbiVersion);
}

}  // namespace hypotrack::internal
