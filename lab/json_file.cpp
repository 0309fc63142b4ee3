#include "lab/json_file.hpp"

#include <fmt/format.h>

#include <fstream>
#include <limits>

#include "base/file_bytes.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack::internal {
namespace {

constexpr std::uintmax_t kLargestFile = std::uintmax_t{64} << 20;

constexpr int kMostLevels = 64;  // deep values would exhaust the stack where they are copied

}  // namespace

Json read_json_object(const std::filesystem::path& file, std::string_view advice) {
  if (const std::string why = why_no_file(file); !why.empty())
    throw DataError(fmt::format("{}: {}; expected a JSON object{}{}", file.string(), why,
                                advice.empty() ? "" : "; ", advice));
  std::error_code error;
  if (advice.empty()) advice = kRepeatRun;
  if (std::filesystem::file_size(file, error) > kLargestFile)
    throw DataError(fmt::format("{}: is larger than {} MiB", file.string(), kLargestFile >> 20));
  std::ifstream in(file, std::ios::binary);
  Json json;
  try {
    json = Json::parse(in, [&](int depth, Json::parse_event_t, const Json&) {
      if (depth > kMostLevels)
        throw DataError(fmt::format("{}: is nested more than {} levels deep; {}", file.string(),
                                    kMostLevels, advice));
      return true;
    });
  } catch (const Json::exception& e) {
    throw DataError(fmt::format("{}: is no JSON ({}); {}", file.string(), e.what(), advice));
  }
  if (!json.is_object())
    throw DataError(fmt::format("{}: holds a JSON {}, expected an object; {}", file.string(),
                                json.type_name(), advice));
  return json;
}

double number_in(const Json& object, const char* key, const std::filesystem::path& file) {
  const auto it = object.find(key);
  if (it == object.end() || it->is_null()) return std::numeric_limits<double>::quiet_NaN();
  if (!it->is_number())
    throw DataError(fmt::format("{}: '{}' is a {}, expected a number; {}", file.string(), key,
                                it->type_name(), kRepeatRun));
  return it->get<double>();
}

std::int64_t integer_in(const Json& object, const char* key, const std::filesystem::path& file) {
  const auto it = object.find(key);
  const bool found = it != object.end();
  constexpr std::uint64_t kMost = std::numeric_limits<std::int64_t>::max();
  if (found && it->is_number_integer() &&
      !(it->is_number_unsigned() && it->get<std::uint64_t>() > kMost))
    return it->get<std::int64_t>();
  throw DataError(fmt::format("{}: '{}' is {}, expected a whole number; {}", file.string(), key,
                              !found            ? "missing"
                              : it->is_number() ? it->dump()
                                                : it->type_name(),
                              kRepeatRun));
}

std::string text_in(const Json& object, const char* key, const std::filesystem::path& file) {
  const auto it = object.find(key);
  if (it == object.end() || !it->is_string())
    throw DataError(fmt::format("{}: '{}' is {}, expected a text; {}", file.string(), key,
                                it == object.end() ? "missing" : it->type_name(), kRepeatRun));
  return it->get<std::string>();
}

}  // namespace hypotrack::internal
