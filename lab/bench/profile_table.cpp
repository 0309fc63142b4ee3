#include <fmt/format.h>

#include <algorithm>

#include "lab/bench/bench_table.hpp"

namespace hypotrack::bench::internal {
namespace {

using Parts = std::vector<Profile::Part>;

/// Writes the parts within a part, and theirs below each.
void write_inner(const Parts& parts, std::size_t outer, std::size_t depth, double frames,
                 std::string& text) {
  constexpr std::size_t kWidth = 36;
  std::vector<std::size_t> inner;
  for (std::size_t i = 1; i < parts.size(); ++i)
    if (parts[i].parent == outer) inner.push_back(i);
  double rest = outer == 0 || inner.empty() ? 0 : parts[outer].seconds;
  const auto write = [&](std::string_view name, double seconds, const std::string& waits,
                         const std::string& beside, const std::string& calls) {
    text += fmt::format("{:<{}} {:>9.3f} {:>9} {:>9} {:>9}\n",
                        fmt::format("{:{}}{}", "", 2 * depth, name), kWidth,
                        1000 * seconds / frames, waits, beside, calls);
  };
  for (const std::size_t i : inner) {
    const Profile::Part& part = parts[i];
    write(part.name, part.seconds, fmt::format("{:.3f}", 1000 * part.waited_seconds / frames),
          fmt::format("{:.3f}", 1000 * part.beside_seconds / frames),
          fmt::format("{:.1f}", static_cast<double>(part.calls) / frames));
    write_inner(parts, i, depth + 1, frames, text);
    rest -= part.seconds;
  }
  constexpr double kShown = 0.02;  // of the outer part
  if (outer != 0 && rest > kShown * parts[outer].seconds) write("(the rest)", rest, "", "", "");
}

}  // namespace

std::string profile_text(const Plan& plan, const std::vector<Row>& rows, int round) {
  std::string text;
  for (const Row& row : rows) {
    const Measurement& m = row.measurement;
    if (row.round != round || m.parts.size() < 2 || m.seconds.empty()) continue;
    text += fmt::format("\n{:<36} {:>9} {:>9} {:>9} {:>9}\n",
                        fmt::format("{}, {}", plan.cases[row.case_index].label,
                                    plan.configurations[row.configuration].name),
                        "ms/frame", "GPU waits", "beside", "calls");
    write_inner(m.parts, 0, 0, static_cast<double>(m.seconds.size()), text);
  }
  return text;
}

}  // namespace hypotrack::bench::internal
