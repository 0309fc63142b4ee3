#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

namespace hypotrack::study {

/// Reads a map from a JSON file, with its keys in order. Throws DataError if the file cannot be
/// read or is not a map.
nlohmann::ordered_json read_json(const std::filesystem::path& file);

}  // namespace hypotrack::study
