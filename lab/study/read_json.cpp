#include "lab/study/read_json.hpp"

#include <fmt/format.h>

#include <fstream>

#include "hypotrack/error.hpp"

namespace hypotrack::study {

nlohmann::ordered_json read_json(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const auto json = nlohmann::ordered_json::parse(in, nullptr, false);
  if (!in || !json.is_object())
    throw DataError(
        fmt::format("{}: cannot be read as JSON; remove the folder {} and the run will "
                    "be made again",
                    file.string(), file.parent_path().string()));
  return json;
}

}  // namespace hypotrack::study
