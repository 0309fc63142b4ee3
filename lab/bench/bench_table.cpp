#include "lab/bench/bench_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lab/bench/bench_numbers.hpp"

namespace hypotrack::bench::internal {
namespace {

/// Footnotes without repetition, in order of first use.
class Lines {
 public:
  /// Returns the number of a line, from 1; adds it if it is new.
  std::size_t number_of(const std::string& line) {
    const auto found = std::find(lines_.begin(), lines_.end(), line);
    if (found != lines_.end()) return static_cast<std::size_t>(found - lines_.begin()) + 1;
    lines_.push_back(line);
    return lines_.size();
  }
  const std::vector<std::string>& all() const { return lines_; }

 private:
  std::vector<std::string> lines_;
};

/// Formats with a prefix: `58.6 k`, `3.07 M`.
std::string with_prefix(double value) {
  if (value >= 1e6) return fmt::format("{:.2f} M", value / 1e6);
  if (value >= 1e3) return fmt::format("{:.1f} k", value / 1e3);
  return fmt::format("{:.0f}", value);
}

/// Formats with three digits or more.
std::string short_number(double value) {
  const int decimals = value >= 100 ? 0 : value >= 10 ? 1 : value >= 1 ? 2 : 3;
  return fmt::format("{:.{}f}", value, decimals);
}

std::string error_text(double mm) { return std::isnan(mm) ? "-" : fmt::format("{:.2f}", mm); }

std::string share_text(double share) {
  return std::isnan(share) ? "-" : fmt::format("{:.1f}", 100 * share);
}

/// One round of the table, written row by row.
class Table {
 public:
  Table(const Plan& plan, const std::vector<Row>& rows, int round);
  std::string text();

 private:
  std::string head() const;
  std::string line(const Row& row);
  std::string numbers(const Row& row, const Numbers& numbers) const;

  const Plan& plan_;
  const std::vector<Row>& rows_;
  int round_;
  std::size_t case_width_ = 5, configuration_width_ = 7;
  bool tells_memory_ = false;
  std::vector<std::size_t> references_;  ///< configurations to compare with: all measured ones, if
                                         ///< there are two
  Lines reasons_;
};

Table::Table(const Plan& plan, const std::vector<Row>& rows, int round)
    : plan_(plan), rows_(rows), round_(round) {
  for (const Case& c : plan.cases) case_width_ = std::max(case_width_, c.label.size());
  for (const Configuration& configuration : plan.configurations)
    configuration_width_ = std::max(configuration_width_, configuration.name.size());
  for (std::size_t configuration = 0; configuration < plan.configurations.size(); ++configuration)
    if (std::any_of(rows.begin(), rows.end(), [&](const Row& row) {
          return row.configuration == configuration && numbers_of(row.measurement);
        }))
      references_.push_back(configuration);
  if (references_.size() < 2) references_.clear();
  tells_memory_ = std::any_of(rows.begin(), rows.end(),
                              [](const Row& row) { return row.measurement.device_mib; });
}

std::string Table::head() const {
  std::string text =
      fmt::format("{:<{}}  {:<{}} {:>7} {:>9} {:>9} {:>9} {:>8} {:>9} {:>9} {:>9}", "scene",
                  case_width_, "backend", configuration_width_, "frames", "median ms", "5 %",
                  "95 %", "fps", "evals/s", "error mm", "tracked %");
  if (tells_memory_) text += fmt::format(" {:>9}", "GPU MiB");
  for (const std::size_t configuration : references_)
    text += fmt::format(" {:>9}", "x " + plan_.configurations[configuration].name);
  return text + "\n";
}

std::string Table::numbers(const Row& row, const Numbers& n) const {
  const Measurement& m = row.measurement;
  std::string text = fmt::format(
      "{:>7} {:>9.3f} {:>9.3f} {:>9.3f} {:>8} {:>9} {:>9} {:>9}", m.seconds.size(), 1000 * n.median,
      1000 * n.p5, 1000 * n.p95, short_number(n.fps), with_prefix(n.evaluations_per_second),
      error_text(m.metrics.mean_error_mm), share_text(m.metrics.status.tracked_share));
  if (tells_memory_)
    text += fmt::format(" {:>9}", m.device_mib ? fmt::format("{:.0f}", *m.device_mib) : "-");
  for (const std::size_t configuration : references_) {
    const auto speed = speed_over(row, configuration, rows_);
    text += fmt::format(" {:>9}", speed ? short_number(*speed) : "-");
  }
  return text;
}

std::string Table::line(const Row& row) {
  const Measurement& m = row.measurement;
  const auto n = numbers_of(m);
  return fmt::format(
      "{:<{}}  {:<{}} {}\n", plan_.cases[row.case_index].label, case_width_,
      plan_.configurations[row.configuration].name, configuration_width_,
      n ? numbers(row, *n)
        : fmt::format("      - {} [{}]", to_string(m.outcome), reasons_.number_of(m.message)));
}

std::string Table::text() {
  std::string text = head();
  Lines devices;
  for (const Row& row : rows_) {
    if (row.round != round_) continue;
    text += line(row);
    if (!row.measurement.device.empty())
      devices.number_of(plan_.configurations[row.configuration].name + ": " +
                        row.measurement.device);
  }
  text += "\n";
  for (const std::string& device : devices.all()) text += device + "\n";
  for (const std::string& reason : reasons_.all())
    text += fmt::format("[{}] {}\n", reasons_.number_of(reason), reason);
  return text;
}

}  // namespace

std::string in_words(const Measurement& measurement) {
  const auto numbers = numbers_of(measurement);
  if (!numbers) return fmt::format("{}: {}", to_string(measurement.outcome), measurement.message);
  return fmt::format("{:.3f} ms, {} fps ({} frames)", 1000 * numbers->median,
                     short_number(numbers->fps), measurement.seconds.size());
}

std::string table_text(const Plan& plan, const std::vector<Row>& rows, int round) {
  return Table(plan, rows, round).text();
}

}  // namespace hypotrack::bench::internal
