#include <fmt/format.h>

#include "description.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack::articulated {

Description read_urdf(const std::filesystem::path& file, double) {
  throw DataError(
      fmt::format("{}: this hypotrack was built without urdfdom, which reads URDF files; install "
                  "liburdfdom-dev and build it again",
                  file.string()));
}

}  // namespace hypotrack::articulated
