#pragma once

#include <cstdint>
#include <filesystem>

namespace hypotrack::detail {

/// How many bytes an ELF file must have by its headers; 0 for what is no ELF file of this machine's
/// word size, or is too short for its first header. The dynamic linker maps a file that was cut off
/// as if it were whole, and the program then dies of SIGBUS.
std::uintmax_t elf_size(const std::filesystem::path& file);

}  // namespace hypotrack::detail
