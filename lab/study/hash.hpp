#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string_view>

#include "base/exported.hpp"

namespace hypotrack::study {
inline namespace HYPOTRACK_EXPORTED internal {

/// 64-bit FNV-1a hash (Fowler, Noll, Vo) of a sequence of texts, which do not run together. It is
/// the same on every machine.
class Hash {
 public:
  void add(std::string_view text) {
    for (const char c : fmt::format("{}:", text.size())) add_byte(static_cast<unsigned char>(c));
    for (const char c : text) add_byte(static_cast<unsigned char>(c));
  }
  std::uint64_t value() const { return value_; }

 private:
  void add_byte(unsigned char byte) { value_ = (value_ ^ byte) * 0x100000001b3; }

  std::uint64_t value_ = 0xcbf29ce484222325;
};

}  // namespace internal
}  // namespace hypotrack::study
