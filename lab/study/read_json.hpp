#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

namespace hypotrack::study {

/// A map in a JSON file, its keys in the order of the file. Throws DataError if it cannot be read
/// or is none.
nlohmann::ordered_json read_json(const std::filesystem::path& file);

}  // namespace hypotrack::study
