#include "lab/study/hash.hpp"

#include <fmt/format.h>

namespace hypotrack::study::internal {

void Hash::add_byte(unsigned char byte) { value_ = (value_ ^ byte) * 0x100000001b3; }

void Hash::add(std::string_view text) {
  for (const char c : fmt::format("{}:", text.size())) add_byte(static_cast<unsigned char>(c));
  for (const char c : text) add_byte(static_cast<unsigned char>(c));
}

}  // namespace hypotrack::study::internal
