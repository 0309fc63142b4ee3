#include <elf.h>
#include <link.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <limits>

#include "plugin/library.hpp"

namespace hypotrack::detail::internal {
namespace {

constexpr unsigned char kClass = sizeof(void*) == 8 ? ELFCLASS64 : ELFCLASS32;
constexpr std::uintmax_t kMost = std::numeric_limits<std::uintmax_t>::max();

/// Returns the end of a part, saturated: a damaged header may contain any numbers.
std::uintmax_t end_of(std::uintmax_t begin, std::uintmax_t size) {
  return size > kMost - begin ? kMost : begin + size;
}

template <class T>
bool read_at(std::ifstream& in, std::uintmax_t offset, T& value) {
  in.clear();
  in.seekg(static_cast<std::streamoff>(offset));
  in.read(reinterpret_cast<char*>(&value), sizeof(T));
  return in.gcount() == static_cast<std::streamsize>(sizeof(T));
}

}  // namespace

std::uintmax_t elf_size(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  ElfW(Ehdr) header{};
  if (!read_at(in, 0, header) || std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0 ||
      header.e_ident[EI_CLASS] != kClass)
    return 0;
  std::uintmax_t size =
      std::max(end_of(header.e_phoff, std::uintmax_t{header.e_phnum} * header.e_phentsize),
               end_of(header.e_shoff, std::uintmax_t{header.e_shnum} * header.e_shentsize));
  ElfW(Phdr) segment{};
  for (unsigned i = 0; i < header.e_phnum; ++i)
    if (read_at(in, end_of(header.e_phoff, std::uintmax_t{i} * header.e_phentsize), segment))
      size = std::max(size, end_of(segment.p_offset, segment.p_filesz));
  return size;
}

}  // namespace hypotrack::detail::internal
