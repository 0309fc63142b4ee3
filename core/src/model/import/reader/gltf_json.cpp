#include "model/import/reader/gltf_json.hpp"

#include <cmath>
#include <stdexcept>

namespace hypotrack::mesh_wire::internal {

Json parse_gltf(const char* begin, const char* end) {
  constexpr int kDeepest = 64;
  const auto check_depth = [](int depth, Json::parse_event_t, Json&) {
    if (depth > kDeepest) throw std::runtime_error("its JSON is nested deeper than 64 levels");
    return true;
  };
  try {
    Json root = Json::parse(begin, end, check_depth);
    if (!root.is_object()) throw std::runtime_error("its JSON is no object");
    return root;
  } catch (const Json::parse_error& error) {
    throw std::runtime_error("its JSON is damaged at byte " + std::to_string(error.byte) +
                             "; copy or export it again");
  }
}

const Json& member(const Json& object, const char* key) {
  static const Json none;
  const auto found = object.find(key);
  return found == object.end() ? none : *found;
}

const Json& list(const Json& object, const char* key) {
  static const Json none = Json::array();
  const Json& value = member(object, key);
  if (value.is_null()) return none;
  if (!value.is_array()) throw std::runtime_error(std::string("'") + key + "' is no list");
  return value;
}

std::string text(const Json& object, const char* key) {
  const Json& value = member(object, key);
  return value.is_string() ? value.get<std::string>() : std::string();
}

std::vector<double> morph_weights(const Json& object) {
  std::vector<double> weights;
  for (const Json& value : list(object, "weights")) {
    if (!value.is_number()) throw std::runtime_error("a value of 'weights' is no number");
    weights.push_back(value.get<double>());
  }
  return weights;
}

std::uint64_t whole(const Json& value, const std::string& name) {
  constexpr std::uint64_t kMost = std::uint64_t{1} << 48;
  if (value.is_number_unsigned() && value.get<std::uint64_t>() <= kMost)
    return value.get<std::uint64_t>();
  if (value.is_number_float()) {  // 4.0 is a whole number of JSON, too
    const double number = value.get<double>();
    if (number >= 0 && number <= static_cast<double>(kMost) && number == std::floor(number))
      return static_cast<std::uint64_t>(number);
  }
  throw std::runtime_error("a value of '" + name + "' is no whole number from 0 on");
}

std::uint64_t whole(const Json& object, const char* key, std::uint64_t otherwise) {
  const Json& value = member(object, key);
  return value.is_null() ? otherwise : whole(value, key);
}

const Json& item(const Json& root, const char* list_name, const Json& index) {
  const Json& all = list(root, list_name);
  const std::uint64_t at = whole(index, list_name);
  if (at >= all.size())
    throw std::runtime_error("it names item " + std::to_string(at) + " of '" + list_name +
                             "', but there are " + std::to_string(all.size()));
  return all[static_cast<std::size_t>(at)];
}

}  // namespace hypotrack::mesh_wire::internal
