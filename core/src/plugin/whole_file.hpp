#pragma once

#include <cstdint>
#include <filesystem>

#include "base/exported.hpp"

namespace hypotrack::detail {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns the size in bytes that an ELF file must have by its headers. Detects truncated files:
/// the dynamic linker maps them as if complete, and the program then dies of SIGBUS. Returns 0 if
/// the file is not an ELF file of this machine's word size or lacks a whole first header.
std::uintmax_t elf_size(const std::filesystem::path& file);

}  // namespace internal
}  // namespace hypotrack::detail
