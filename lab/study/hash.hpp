#pragma once

#include <cstdint>
#include <string_view>

namespace hypotrack::study {

/// FNV-1a with 64 bits (Fowler, Noll, Vo) over texts that stay apart from each other: the same on
/// every machine.
class Hash {
 public:
  void add(std::string_view text);
  std::uint64_t value() const { return value_; }

 private:
  void add_byte(unsigned char byte);
  std::uint64_t value_ = 0xcbf29ce484222325;
};

}  // namespace hypotrack::study
