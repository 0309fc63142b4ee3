#include "lab/report/study_data.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <set>

namespace hypotrack::internal {

bool parse_number(std::string_view text, double& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} && end == text.data() + text.size() && std::isfinite(number);
}

std::string canonical_value(const std::string& text) {
  double number = 0;
  return parse_number(text, number) ? fmt::format("{}", number) : text;
}

double StudyRun::number(const std::string& name) const {
  for (const auto* numbers : {&metrics, &timing})
    if (const auto it = numbers->find(name); it != numbers->end()) return it->second;
  return std::numeric_limits<double>::quiet_NaN();
}

std::string StudyRun::on_axis(std::string_view key) const {
  if (key == "scene") return scene;
  if (key == "seed") return fmt::format("{}", seed);
  const auto it = settings.find(std::string(key));
  return it == settings.end() ? std::string() : it->second;
}

const StudyAxis* StudyData::axis(std::string_view key) const {
  for (const StudyAxis& candidate : axes)
    if (candidate.key == key) return &candidate;
  return nullptr;
}

std::string StudyData::axis_label(std::string_view key) const {
  const StudyAxis* found = axis(key);
  return found ? found->label : std::string(key);
}

std::string StudyData::value_label(std::string_view key, const std::string& value) const {
  if (key == "scene")
    for (const StudyScene& scene : scenes)
      if (scene.name == value) return scene.label;
  return value;
}

bool StudyData::is_numeric(std::string_view key) const {
  const StudyAxis* found = axis(key);
  return key == "seed" || (found && found->numeric);
}

std::vector<std::string> StudyData::values_of(std::string_view key) const {
  std::vector<std::string> values;
  if (key == "seed") {
    std::set<long> seeds;
    for (const StudyRun& run : runs) seeds.insert(run.seed);
    for (const long seed : seeds) values.push_back(fmt::format("{}", seed));
    return values;
  }
  if (key == "scene") {
    for (const StudyScene& scene : scenes) values.push_back(scene.name);
  } else if (const StudyAxis* found = axis(key)) {
    values = found->values;
  }
  return values;
}

}  // namespace hypotrack::internal
