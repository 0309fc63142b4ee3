// libFuzzer's side of a target: the one that is linked into the program.

#include <cstddef>
#include <cstdint>

#include "target.hpp"

/// Adds the target's dictionary to the arguments.
extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  using namespace hypotrack::fuzz;
  static std::string dictionary =
      "-dict=" + (fuzz_folder() / "dictionaries" / targets().front().dictionary).string() + ".dict";
  static std::vector<char*> arguments(*argv, *argv + *argc);
  arguments.insert(arguments.begin() + 1, dictionary.data());
  *argc = static_cast<int>(arguments.size());
  arguments.push_back(nullptr);
  *argv = arguments.data();
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace hypotrack::fuzz;
  attempt([&] { targets().front().read({reinterpret_cast<const char*>(data), size}); });
  return 0;
}

// Undefined behaviour ends the program, as every other fault does.
extern "C" const char* __ubsan_default_options() { return "halt_on_error=1:print_stacktrace=1"; }
