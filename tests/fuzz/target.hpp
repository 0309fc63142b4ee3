#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "hypotrack/api/error.hpp"

namespace hypotrack::fuzz {

/// A reader under test. It takes any bytes: it reads them or throws hypotrack::Error. Everything
/// else is a fault: other exceptions, crashes, undefined behaviour, long runs, much memory.
struct Target {
  std::string_view name;        ///< of its folders in corpus/ and found/
  std::string_view dictionary;  ///< file in dictionaries/, without .dict
  void (*read)(std::string_view bytes);
};

/// Returns the targets that are linked into the program.
std::vector<Target>& targets();

/// Adds a target, for HYPOTRACK_FUZZ_TARGET.
bool add_target(const Target& target);

/// Calls a function. Returns false if it throws hypotrack::Error, which must have a message.
template <class Function>
bool attempt(const Function& read) {
  try {
    read();
    return true;
  } catch (const Error& error) {
    if (std::string_view(error.what()).empty()) throw std::logic_error("an error has no message");
    return false;
  }
}

/// Throws std::logic_error unless a property of something that was read holds.
void require(bool holds, std::string_view property);

/// Returns a folder of this process, which is removed at its end.
const std::filesystem::path& scratch();

/// Writes a file of scratch() and returns its path.
std::filesystem::path scratch_file(const std::filesystem::path& name, std::string_view bytes);

/// Returns the folder tests/fuzz of the source tree.
std::filesystem::path fuzz_folder();

}  // namespace hypotrack::fuzz

/// Defines a target at file scope of namespace hypotrack::fuzz: the body of a function of `bytes`.
#define HYPOTRACK_FUZZ_TARGET(name, dictionary)                         \
  static void fuzz_##name(std::string_view bytes);                      \
  static const bool added_##name =                                      \
      ::hypotrack::fuzz::add_target({#name, dictionary, &fuzz_##name}); \
  static void fuzz_##name(std::string_view bytes)
