
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "hypotrack/api/error.hpp"
#include "plugin/library.hpp"

namespace hypotrack::detail::internal {
namespace {

void write_line(std::string line) {
  line += '\n';
  for (std::string_view rest = line; !rest.empty();) {
    const ssize_t written = write(kProbeDescriptor, rest.data(), rest.size());
    if (written <= 0) _exit(2);  // the reader has gone
    rest.remove_prefix(static_cast<std::size_t>(written));
  }
}

nlohmann::json describe(const HypotrackPlugin& plugin) {
  return {{"version", plugin.version},
          {"summary", plugin.summary},
          {"licence", plugin.licence},
          {"capabilities", plugin.capabilities},
          {"parameters", plugin.describe()}};
}

nlohmann::json problem(std::string_view text) { return {{"problem", text}}; }

nlohmann::json probe(const std::filesystem::path& file) {
  const auto id = id_from_file_name(file);
  if (!id) return problem("is not named like a plugin; expected libhypotrack_KIND_NAME.so");
  try {
    write_line(kProbeLoading);
    void* library = load_library(file);
    write_line(kProbeEntry);
    const HypotrackPlugin& plugin = descriptor_of(library);
    const std::string mismatch = find_mismatch(plugin, *id);
    if (!mismatch.empty()) return problem(mismatch);
    write_line(kProbeDescribing);
    return describe(plugin);
  } catch (const std::exception& e) {
    return problem(e.what());
  } catch (...) {
    return problem("threw something that is no std::exception");
  }
}

}  // namespace

void run_probe(const std::filesystem::path& file) {
  const rlimit none{0, 0};
  setrlimit(RLIMIT_CORE, &none);  // crashes are expected here
  const nlohmann::json report = probe(file);
  write_line(report.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace));
  _exit(0);  // skips the destructors of a library that may be broken
}

}  // namespace hypotrack::detail::internal
