#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/exported.hpp"

// Access to the JSON of a glTF file, of which nothing can be trusted. All functions throw
// std::runtime_error with the name of what is wrong.
namespace hypotrack::mesh_wire {
inline namespace HYPOTRACK_EXPORTED internal {

using Json = nlohmann::json;

/// Parses a text. Refuses values that are nested deeper than 64 levels, on which recursive
/// functions would end their stack.
Json parse_gltf(const char* begin, const char* end);

/// Returns the value of a key; null if there is none.
const Json& member(const Json& object, const char* key);
/// Returns the list of a key; an empty list if there is none.
const Json& list(const Json& object, const char* key);
/// Returns the text of a key; an empty one if there is none.
std::string text(const Json& object, const char* key);

/// Returns the weights of morph targets of a mesh or node, one per target; empty if it has none.
std::vector<double> morph_weights(const Json& object);

/// Returns a value as a whole number from 0 to 2^48.
std::uint64_t whole(const Json& value, const std::string& name);
/// Returns the whole number of a key, or `otherwise` if there is none.
std::uint64_t whole(const Json& object, const char* key, std::uint64_t otherwise);

/// Returns the item of a top-level list that an index names.
const Json& item(const Json& root, const char* list_name, const Json& index);

}  // namespace internal
}  // namespace hypotrack::mesh_wire
