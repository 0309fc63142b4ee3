#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

namespace hypotrack {

using Json = nlohmann::ordered_json;

/// Reads a JSON object. Throws DataError, naming the file and the position, if there is no such
/// file, it is larger than 64 MiB, it is no JSON or anything but an object.
Json read_json_object(const std::filesystem::path& file);

/// A member as a number; NaN if it is null or absent. Throws DataError if it is anything else.
double number_in(const Json& object, const char* key, const std::filesystem::path& file);
/// A member as text. Throws DataError if it is absent or no string.
std::string text_in(const Json& object, const char* key, const std::filesystem::path& file);

}  // namespace hypotrack
