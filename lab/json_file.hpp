#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

using Json = nlohmann::ordered_json;

/// What to do about a damaged file of a run, for a message.
inline constexpr std::string_view kRepeatRun = "repeat the run that wrote it, or remove it";

/// Reads a JSON object, its keys in the file's order. Throws DataError, naming the file and the
/// position, if the file does not exist, is larger than 64 MiB, is no JSON, is nested more than 64
/// levels deep or is anything but an object. Messages end with `advice`.
Json read_json_object(const std::filesystem::path& file, std::string_view advice = {});

/// Returns a member as a number; NaN if it is null or absent. Throws DataError if it is anything
/// else.
double number_in(const Json& object, const char* key, const std::filesystem::path& file);
/// Returns a member as a whole number. Throws DataError if it is absent or anything else.
std::int64_t integer_in(const Json& object, const char* key, const std::filesystem::path& file);
/// Returns a member as text. Throws DataError if it is absent or no string.
std::string text_in(const Json& object, const char* key, const std::filesystem::path& file);

}  // namespace internal
}  // namespace hypotrack
